// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/vec3.hpp"

namespace fexp::model {

/// Eigenvalues of a symmetric 3 x 3 matrix, ascending, and unit vectors along its axes, a right-handed frame.
struct PrincipalAxes {
  std::array<double, 3> value{};
  std::array<Vec3d, 3> axis{};
};

/// `matrix`: xx, yy, zz, xy, yz, zx. By Jacobi's rotations, made of + - * / and roots alone. A diagonal matrix keeps
/// the axes of the model.
[[nodiscard]] PrincipalAxes principal_axes(const std::array<double, 6>& matrix) noexcept;

}  // namespace fexp::model
