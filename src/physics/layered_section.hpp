// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/inline.hpp"
#include "physics/hardening.hpp"
#include "physics/plane_stress_material.hpp"
#include "physics/through_thickness.hpp"

/// Shell sections with points through the thickness and the history of their elements.
namespace fexp::physics {

/// Elastic constants as the return needs them.
struct J2Elasticity {
  double compliance{};  ///< 1/(3 G) [length^2/force]
  double ratio{};       ///< E/(2 (1 - nu))/(3 G), below 1 [-]
  double inverse_ratio{};
  double spread{};      ///< 3/2 (1 - ratio)^2 [-]
  double transverse{};  ///< -nu/E [length^2/force]

  [[nodiscard]] static J2Elasticity of(const PlaneStressModuli& m) noexcept {
    const double triple_shear = 3.0 * m.shear, ratio = 0.5 * (m.direct + m.cross) / triple_shear;
    return {1.0 / triple_shear, ratio, 1.0 / ratio, 1.5 * (1.0 - ratio) * (1.0 - ratio),
            -m.cross / (m.direct * m.direct - m.cross * m.cross)};
  }
};

/// Rows of the history of a layered element; each of its points has PointRow from layer_points on.
enum LayerRow : int {
  layer_thickness,    // Present thickness [length]
  layer_dissipation,  // Plastic work of the element [force*length]
  layer_deleted,      // 0; once all points have failed the number of steps since then and one, at most 2
  layer_points
};
enum PointRow : int {
  point_sum,
  point_difference,
  point_shear,   // Stresses sxx + syy, sxx - syy and sxy in the element frame [force/length^2]
  point_strain,  // Effective plastic strain [-]
  point_rows
};

/// What the kernels need of such a section; no points: the section is elastic.
struct LayeredSection {
  ThroughThickness points;
  PlaneStressModuli moduli;
  J2Elasticity elasticity;
  J2Plasticity plasticity;

  /// Whether points have more to remember than PointRow, or another law of the rate than Johnson and Cook's.
  [[nodiscard]] FEXP_INLINE constexpr bool has_conditions() const noexcept {
    return plasticity.heat.heats() || plasticity.rate.filters() || plasticity.rate.inverse_exponent > 0.0;
  }
  /// Behind PointRow of all points come their temperatures [temperature] where they heat, and then their filtered rates
  /// of strain [1/time] where these are filtered.
  [[nodiscard]] FEXP_INLINE constexpr int temperature_row(int point) const noexcept {
    return layer_points + points.count * point_rows + point;
  }
  [[nodiscard]] FEXP_INLINE constexpr int rate_row(int point) const noexcept {
    return temperature_row(plasticity.heat.heats() ? points.count : 0) + point;
  }
  [[nodiscard]] constexpr int rows() const noexcept {
    return points.count == 0 ? 0 : rate_row(plasticity.rate.filters() ? points.count : 0);
  }
};

}  // namespace fexp::physics
