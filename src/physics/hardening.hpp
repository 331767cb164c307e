// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <variant>

#include "base/elementary.hpp"
#include "base/inline.hpp"
#include "base/pack.hpp"
#include "physics/adiabatic_heating.hpp"
#include "physics/rate_dependence.hpp"

/// Yield stress over effective plastic strain, made ready for the kernels: values `at(strain, slope)` of any number
/// type, from `least()` on, `smooth` or with corners. None falls anywhere, so that a return to the yield surface has
/// one solution.
namespace fexp::physics {

/// Y = yield + slope ep.
struct LinearHardening {
  static constexpr bool smooth = true;

  double yield{};  ///< [force/length^2]
  double slope{};  ///< [force/length^2]

  [[nodiscard]] FEXP_INLINE double least() const noexcept { return yield; }
  template <class T>
  [[nodiscard]] FEXP_INLINE T at(const T& strain, T& derivative) const noexcept {
    derivative = T(slope);
    return T(yield) + T(slope) * strain;
  }
};

/// Y = a + b ep^n; below a strain of 1e-6, where the slope goes to infinity, the chord.
struct PowerHardening {
  static constexpr bool smooth = true;
  static constexpr double least_strain = 1.0e-6;

  double a{};  ///< [force/length^2]
  double b{};  ///< [force/length^2]
  double n{};  ///< > 0 and <= 1 [-]

  [[nodiscard]] FEXP_INLINE double least() const noexcept { return a; }
  template <class T>
  [[nodiscard]] FEXP_INLINE T at(const T& strain, T& derivative) const noexcept {
    const T least(least_strain), not_less = maximum(strain, least);
    const T secant = T(b) * power(not_less, n - 1.0);
    derivative = select_less(strain, least, secant, T(n) * secant);
    return T(a) + secant * strain;
  }
};

/// Most points of a table of hardening.
inline constexpr std::size_t most_table_points = 64;

/// Linear between points, constant behind the last one.
struct TableHardening {
  static constexpr bool smooth = false;

  std::size_t count{};
  std::array<double, most_table_points> strain{};  // Ascending from 0 [-]
  std::array<double, most_table_points> stress{};  // [force/length^2]
  std::array<double, most_table_points> slope{};   // To the next point, 0 behind the last [force/length^2]

  [[nodiscard]] FEXP_INLINE double least() const noexcept { return stress[0]; }
  template <class T>
  [[nodiscard]] FEXP_INLINE T at(const T& at_strain, T& derivative) const noexcept {
    T from(strain[0]), value(stress[0]);
    derivative = T(slope[0]);
    for (std::size_t i = 1; i < count; ++i) {
      const T next(strain[i]);
      from = select_less(at_strain, next, from, next);
      value = select_less(at_strain, next, value, T(stress[i]));
      derivative = select_less(at_strain, next, derivative, T(slope[i]));
    }
    return value + derivative * (at_strain - from);
  }
};

using Hardening = std::variant<LinearHardening, PowerHardening, TableHardening>;

/// What makes an elastic law plastic: hardening, what else the yield stress depends on, and failure.
struct J2Plasticity {
  Hardening hardening;
  RateDependence rate;
  ThermalSoftening heat;
  /// Effective plastic strain at which a point fails [-]
  double failure_strain{std::numeric_limits<double>::infinity()};

  [[nodiscard]] constexpr bool can_fail() const noexcept {
    return failure_strain < std::numeric_limits<double>::infinity();
  }
};

}  // namespace fexp::physics
