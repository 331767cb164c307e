// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "model/model.hpp"

namespace fexp::model {

/// What a body is before the run moves it.
struct BodyProperties {
  double mass{};                    ///< [mass]
  Vec3d centre;                     ///< Of mass [length]
  std::array<double, 6> inertia{};  ///< About the centre: xx yy zz xy yz zx, products as -sum m x y [mass*length^2]
  Box box;                          ///< Of the nodes, without thickness [length]
};

/// Integrals over the flat triangles with their thickness, not over the lumped masses that the solver steps.
[[nodiscard]] BodyProperties body_properties(const Model& model, Index body);

/// Of all bodies together.
[[nodiscard]] BodyProperties total_properties(const Model& model);

}  // namespace fexp::model
