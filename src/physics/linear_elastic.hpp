// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include "base/field.hpp"
#include "base/pack.hpp"
#include "physics/plane_stress_material.hpp"

namespace fexp::physics {

/// Isotropic linear elasticity in plane stress (linearised Saint Venant-Kirchhoff in the co-rotated frame).
struct LinearElastic {
  static constexpr std::string_view kind = "linear_elastic";

  double density{};  ///< [mass/length^3]
  double young{};    ///< Young's modulus [force/length^2]
  double poisson{};  ///< Poisson's ratio [-]

  static constexpr Range poisson_range{-1.0, 0.5, false, false, "> -1 and < 0.5"};
  static constexpr auto fields = std::tuple{
      Field{"density", "mass/length^3", "Mass density.", &LinearElastic::density, positive, Presence::required},
      Field{"young", "force/length^2", "Young's modulus.", &LinearElastic::young, positive, Presence::required},
      Field{"poisson", "-", "Poisson's ratio.", &LinearElastic::poisson, poisson_range, Presence::required},
  };

  /// Plane-stress stiffness C = E/(1-nu^2) [[1,nu,0],[nu,1,0],[0,0,(1-nu)/2]].
  [[nodiscard]] constexpr PlaneStressModuli moduli() const noexcept {
    const double membrane = young / (1.0 - poisson * poisson);
    return {membrane, membrane * poisson, young / (2.0 * (1.0 + poisson))};
  }
};

static_assert(PlaneStressMaterial<LinearElastic>);

}  // namespace fexp::physics
