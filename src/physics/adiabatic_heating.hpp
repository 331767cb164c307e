// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <tuple>

#include "base/elementary.hpp"
#include "base/field.hpp"
#include "base/inline.hpp"
#include "base/pack.hpp"

/// Plastic work that heats a metal, and how heat softens it: G. R. Johnson, W. H. Cook, 7th International Symposium on
/// Ballistics, 1983, 541-547. There is no time for heat to flow: each point keeps its own.
namespace fexp::physics {

/// As the deck gives it.
struct AdiabaticHeating {
  double specific_heat{};          ///< [force*length/(mass*temperature)]
  double melting_temperature{};    ///< [temperature]
  double reference_temperature{};  ///< Up to which the yield stress is as given [temperature]
  double initial_temperature{};    ///< [temperature]
  double exponent{1.0};            ///< m of the factor 1 - T*^m [-]
  double fraction{0.9};            ///< Of the plastic work that becomes heat [-] (G. I. Taylor, H. Quinney, 1934)

  static constexpr Range exponent_range{0.0, 10.0, false, true, "> 0 and <= 10"};
  static constexpr Range fraction_range{0.0, 1.0, true, true, ">= 0 and <= 1"};
  static constexpr auto fields = std::tuple{
      Field{"specific_heat", "force*length/(mass*temperature)", "Heat capacity over the mass.",
            &AdiabaticHeating::specific_heat, positive, Presence::required},
      Field{"melting_temperature", "temperature", "Temperature at which the yield stress vanishes.",
            &AdiabaticHeating::melting_temperature, any_number, Presence::required},
      Field{"reference_temperature", "temperature", "Temperature up to which the yield stress is as given.",
            &AdiabaticHeating::reference_temperature, any_number, Presence::required},
      Field{"initial_temperature", "temperature", "Temperature at the start.", &AdiabaticHeating::initial_temperature,
            any_number, Presence::required},
      Field{"exponent", "-", "m of the factor 1 - T*^m, T* from 0 at the reference to 1 where the metal melts.",
            &AdiabaticHeating::exponent, exponent_range},
      Field{"fraction", "-", "Part of the plastic work that becomes heat; 0: the temperature stays.",
            &AdiabaticHeating::fraction, fraction_range},
  };
};

/// As the kernels need it.
struct ThermalSoftening {
  /// What is left of the yield stress at least: the return to the yield surface needs one.
  static constexpr double least_factor = 1.0e-6;

  double heating{};        ///< Temperature over plastic work [temperature*length^2/force]
  double initial{};        ///< [temperature]
  double reference{};      ///< [temperature]
  double inverse_range{};  ///< 1/(melting - reference temperature) [1/temperature]; 0: no heating
  double exponent{1.0};

  [[nodiscard]] static ThermalSoftening of(const AdiabaticHeating& h, double density) noexcept {
    return {h.fraction / (density * h.specific_heat), h.initial_temperature, h.reference_temperature,
            1.0 / (h.melting_temperature - h.reference_temperature), h.exponent};
  }
  [[nodiscard]] constexpr bool heats() const noexcept { return inverse_range > 0.0; }

  /// Factor 1 - T*^m on the yield stress.
  template <class T>
  [[nodiscard]] FEXP_INLINE T factor(const T& temperature) const noexcept {
    constexpr double least = 1.0e-30;  // For the logarithm
    const T ratio = (temperature - T(reference)) * T(inverse_range);
    const T softening = T(1.0) - power(minimum(maximum(ratio, T(least)), T(1.0)), exponent);
    return select_less(ratio, T(least), T(1.0), maximum(softening, T(least_factor)));
  }
};

}  // namespace fexp::physics
