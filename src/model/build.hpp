// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/errors.hpp"
#include "model/description.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// A node's penalty stiffness is c^2 m / dt^2 with the model's first critical step dt and this c. A pair's stiffness is
/// the series combination of both sides', so omega_p dt <= 0.3 for a pair, which keeps a bounce's energy within 2.3 %.
inline constexpr double penalty_courant = 0.3;

/// Freezes a description and the meshes of its bodies (one per body, in order) into a model. Everything wrong is added
/// to `errors`; the model is usable only when nothing was. `positions`, shape [nodes] or empty: where the nodes of a
/// model built before are to be instead; node sets are as in that.
[[nodiscard]] Model build_model(const Description& description, std::span<const Mesh> meshes, ErrorList& errors,
                                std::span<const Vec3d> positions = {});

}  // namespace fexp::model
