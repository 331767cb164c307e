// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/field.hpp"
#include "base/short_list.hpp"
#include "physics/adiabatic_heating.hpp"
#include "physics/hardening.hpp"
#include "physics/linear_elastic.hpp"
#include "physics/plane_stress_material.hpp"
#include "physics/rate_dependence.hpp"

/// Laws of elastic-plastic metals: von Mises's yield condition with isotropic hardening and the flow rule of Prandtl
/// and Reuss, in plane stress. They differ in how the yield stress grows with the effective plastic strain.
namespace fexp::physics {

/// What these laws have in common.
struct J2Law {
  double density{};             ///< [mass/length^3]
  double young{};               ///< Young's modulus [force/length^2]
  double poisson{};             ///< Poisson's ratio [-]
  double rate_sensitivity{};    ///< C of the factor 1 + C ln(rate/reference_rate) [-]
  double reference_rate{1.0};   ///< [1/time]
  double failure_strain{-1.0};  ///< Effective plastic strain [-]; negative: nothing fails
  double rate_cutoff{};         ///< Frequency of the filter of the rate [1/time]; 0: it is not filtered
  std::optional<CowperSymonds> cowper_symonds{};
  std::optional<AdiabaticHeating> heating{};

  static constexpr Range poisson_range{0.0, 0.5, true, false, ">= 0 and < 0.5"};
  static constexpr auto elastic_fields = std::tuple{
      Field{"density", "mass/length^3", "Mass density.", &J2Law::density, positive, Presence::required},
      Field{"young", "force/length^2", "Young's modulus.", &J2Law::young, positive, Presence::required},
      Field{"poisson", "-", "Poisson's ratio.", &J2Law::poisson, poisson_range, Presence::required},
      Field{
          "failure_strain", "-",
          "Effective plastic strain at which a point of the thickness carries no more; an element all of whose points "
          "have failed is deleted. When left out nothing fails.",
          &J2Law::failure_strain, positive},
  };
  static constexpr auto rate_fields = std::tuple{
      Field{"rate_sensitivity", "-",
            "C of the factor 1 + C ln(rate/reference_rate) on the yield stress; 0: it does not depend on the rate.",
            &J2Law::rate_sensitivity, non_negative},
      Field{"reference_rate", "1/time", "Rate of strain up to which the yield stress is as given.",
            &J2Law::reference_rate, positive},
      Field{"cowper_symonds", "-", "Factor 1 + (rate/D)^(1/P) on the yield stress, instead of `rate_sensitivity`.",
            &J2Law::cowper_symonds},
  };
  /// Of all these laws, whatever the rate does.
  static constexpr auto condition_fields = std::tuple{
      Field{"rate_cutoff", "1/time",
            "Frequency above which the rate of strain that the yield stress depends on is filtered out; 0: it is not "
            "filtered.",
            &J2Law::rate_cutoff, non_negative},
      Field{"heating", "-", "Plastic work heats and softens the material; when left out it does not.", &J2Law::heating},
  };

  [[nodiscard]] constexpr PlaneStressModuli moduli() const noexcept {
    return LinearElastic{density, young, poisson}.moduli();
  }
  [[nodiscard]] bool depends_on_rate() const noexcept { return rate_sensitivity > 0.0 || cowper_symonds.has_value(); }
  [[nodiscard]] J2Plasticity with(const Hardening& hardening) const noexcept {
    J2Plasticity plasticity{hardening, {rate_sensitivity, reference_rate, 0.0, rate_cutoff}, {}};
    if (cowper_symonds) {
      plasticity.rate.reference = cowper_symonds->rate;
      plasticity.rate.inverse_exponent = 1.0 / cowper_symonds->exponent;
    }
    if (heating) {
      plasticity.heat = ThermalSoftening::of(*heating, density);
    }
    if (failure_strain > 0.0) {
      plasticity.failure_strain = failure_strain;
    }
    return plasticity;
  }
};

/// The yield stress grows linearly.
struct J2Linear : J2Law {
  static constexpr std::string_view kind = "j2_linear";

  double yield{};            ///< [force/length^2]
  double tangent_modulus{};  ///< Slope of a tensile test's stress over strain beyond the yield stress [force/length^2]

  static constexpr auto fields = std::tuple_cat(
      J2Law::elastic_fields,
      std::tuple{
          Field{"yield", "force/length^2", "Yield stress.", &J2Linear::yield, positive, Presence::required},
          Field{
              "tangent_modulus", "force/length^2",
              "Slope of stress over total strain beyond the yield stress, less than Young's modulus; 0: no hardening.",
              &J2Linear::tangent_modulus, non_negative},
      },
      J2Law::rate_fields, J2Law::condition_fields);

  [[nodiscard]] J2Plasticity plasticity() const noexcept {
    return with(LinearHardening{yield, young * tangent_modulus / (young - tangent_modulus)});
  }
};

/// Y = a + b ep^n.
struct J2Power : J2Law {
  double a{};  ///< [force/length^2]
  double b{};  ///< [force/length^2]
  double n{};  ///< [-]

  static constexpr Range exponent_range{0.0, 1.0, false, true, "> 0 and <= 1"};
  static constexpr std::string_view kind = "j2_power";
  static constexpr auto power_fields = std::tuple{
      Field{"a", "force/length^2", "Yield stress at no plastic strain.", &J2Power::a, positive, Presence::required},
      Field{"b", "force/length^2", "Factor of the plastic strain's power.", &J2Power::b, non_negative,
            Presence::required},
      Field{"n", "-", "Exponent of the plastic strain.", &J2Power::n, exponent_range, Presence::required},
  };
  static constexpr auto fields =
      std::tuple_cat(J2Law::elastic_fields, power_fields, J2Law::rate_fields, J2Law::condition_fields);

  [[nodiscard]] J2Plasticity plasticity() const noexcept { return with(PowerHardening{a, b, n}); }
};

/// The yield stress is given point by point.
struct J2Table : J2Law {
  static constexpr std::string_view kind = "j2_table";

  ShortList<std::array<double, 2>, most_table_points> table;  ///< (effective plastic strain [-], yield stress)

  static constexpr auto fields = std::tuple_cat(
      J2Law::elastic_fields,
      std::tuple{
          Field{
              "table", "-, force/length^2",
              "Pairs [effective plastic strain, yield stress], strains ascending from 0, stresses not falling; linear "
              "between them, constant behind the last one.",
              &J2Table::table, any_number, Presence::required},
      },
      J2Law::rate_fields, J2Law::condition_fields);

  [[nodiscard]] J2Plasticity plasticity() const noexcept {
    TableHardening hardening;
    for (const auto& [strain, stress] : table) {
      const std::size_t i = hardening.count++;
      hardening.strain[i] = strain;
      hardening.stress[i] = stress;
      if (i > 0) {
        hardening.slope[i - 1] = (stress - hardening.stress[i - 1]) / (strain - hardening.strain[i - 1]);
      }
    }
    return with(hardening);
  }
};

/// Y = (a + b ep^n) (1 + c ln(rate/reference_rate)): G. R. Johnson, W. H. Cook, A constitutive model and data for
/// metals subjected to large strains, high strain rates and high temperatures, 7th International Symposium on
/// Ballistics, 1983, 541-547; the dependence on temperature is `heating`, which all these laws may have.
struct JohnsonCook : J2Power {
  static constexpr std::string_view kind = "johnson_cook";
  static constexpr auto fields =
      std::tuple_cat(J2Law::elastic_fields, J2Power::power_fields,
                     std::tuple{
                         Field{"c", "-", "Factor of the logarithm of the rate of strain.", &J2Law::rate_sensitivity,
                               non_negative, Presence::required},
                         Field{"reference_rate", "1/time", "Rate of strain up to which the yield stress is a + b ep^n.",
                               &J2Law::reference_rate, positive, Presence::required},
                     },
                     J2Law::condition_fields);
};

static_assert(PlaneStressMaterial<J2Linear> && PlaneStressMaterial<J2Power> && PlaneStressMaterial<J2Table> &&
              PlaneStressMaterial<JohnsonCook>);

}  // namespace fexp::physics
