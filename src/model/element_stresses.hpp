// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::model {

/// What an element bears, in its own frame: x along the edge from corner 1 to 2, z the normal.
struct ElementStresses {
  std::array<double, 3> membrane_force{};  ///< nxx nyy nxy [force/length]
  std::array<double, 3> bending_moment{};  ///< mxx myy mxy [force]
  std::array<double, 2> shear_force{};     ///< qxz qyz [force/length]
  /// sxx syy sxy on the side the normal points to; at the outermost point where the section has points [force/length^2]
  std::array<double, 3> top{};
  std::array<double, 3> bottom{};  ///< On the other side [force/length^2]
  double thickness{};              ///< [length]
  double plastic_strain{};         ///< Effective, largest of the element's points [-]
  double temperature{};            ///< Highest of the element's points, 0 where they do not heat [temperature]
  bool deleted{};
};

[[nodiscard]] ElementStresses element_stresses(const Model& model, const State& state, Index element);

/// Von Mises stress of a plane-stress state [force/length^2].
[[nodiscard]] double von_mises(double sxx, double syy, double sxy) noexcept;

}  // namespace fexp::model
