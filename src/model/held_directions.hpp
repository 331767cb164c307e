// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "model/model.hpp"

namespace fexp::model {

/// Local axes as unit vectors; without any those of the model.
[[nodiscard]] std::array<Vec3d, 3> unit_axes(const std::optional<LocalAxes>& axes);

/// Whether axes are those of the model, to the bit.
[[nodiscard]] bool are_model_axes(const std::array<Vec3d, 3>& axes) noexcept;

/// What the conditions that are in the model so far (fixed, symmetry, oblique) leave of a rate's direction at a node:
/// the direction itself where it is free, zero where it is held. The conditions must be sorted by node.
[[nodiscard]] Vec3d free_part(const Model& model, Index node, bool angular, const Vec3d& direction);

}  // namespace fexp::model
