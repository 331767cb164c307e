// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string_view>
#include <tuple>

#include "base/elementary.hpp"
#include "base/field.hpp"
#include "base/inline.hpp"
#include "base/pack.hpp"

/// How the yield stress depends on the rate of strain, and the filter that the rate passes first.
namespace fexp::physics {

/// Factor 1 + (rate/D)^(1/P) on the yield stress: G. R. Cowper, P. S. Symonds, Strain-hardening and strain-rate effects
/// in the impact loading of cantilever beams, Brown University, Division of Applied Mathematics report 28, 1957.
struct CowperSymonds {
  double rate{};      ///< D, at which the yield stress is doubled [1/time]
  double exponent{};  ///< P [-]

  static constexpr Range exponent_range{1.0, 100.0, true, true, ">= 1 and <= 100"};
  static constexpr auto fields = std::tuple{
      Field{"rate", "1/time", "D: rate of strain at which the yield stress is doubled.", &CowperSymonds::rate, positive,
            Presence::required},
      Field{"exponent", "-", "P, the root that is taken.", &CowperSymonds::exponent, exponent_range,
            Presence::required},
  };
};

/// One of both laws, or none, as the kernels need it.
struct RateDependence {
  /// C of the factor 1 + C ln(rate/reference) (G. R. Johnson, W. H. Cook, 7th International Symposium on Ballistics,
  /// 1983, 541-547); rates below the reference count as the reference.
  double sensitivity{};
  double reference{1.0};      ///< Of Johnson and Cook, or D of Cowper and Symonds [1/time]
  double inverse_exponent{};  ///< 1/P of Cowper and Symonds [-]; 0: Johnson and Cook
  double cutoff{};            ///< Frequency of the filter [1/time]; 0: none

  [[nodiscard]] constexpr bool filters() const noexcept { return cutoff > 0.0; }

  /// Factor of Johnson and Cook on the yield stress for a squared rate over the squared reference; 1 without any law.
  template <class T>
  [[nodiscard]] FEXP_INLINE T johnson_cook(const T& square) const noexcept {
    if (!(sensitivity > 0.0)) {
      return T(1.0);
    }
    return T(1.0) + T(0.5 * ln2 * sensitivity) * binary_log(maximum(square, T(1.0)));
  }

  /// Factor of whichever law there is.
  template <class T>
  [[nodiscard]] FEXP_INLINE T factor(const T& square) const noexcept {
    if (!(inverse_exponent > 0.0)) {
      return johnson_cook(square);
    }
    constexpr double least = 1.0e-200;  // For the logarithm; at and below it the rate is nothing
    return T(1.0) + select_less(square, T(least), T(0.0), power(maximum(square, T(least)), 0.5 * inverse_exponent));
  }

  /// Part of a constant rate that the filter takes up in a step: that of the equation rate' = 2 pi f (new rate - rate),
  /// 1 - exp(-x) with x = 2 pi f dt.
  [[nodiscard]] FEXP_INLINE double filter_weight(double dt) const noexcept {
    constexpr double most = 600.0;  // Of the exponential, which is nothing there
    constexpr double least = 0.02;  // Below it the series is good to 1e-11, and the difference loses digits
    const double x = 2.0 * std::numbers::pi * cutoff * dt;
    if (x < least) {
      return x * (1.0 - x * (1.0 / 2.0) * (1.0 - x * (1.0 / 3.0) * (1.0 - x * (1.0 / 4.0) * (1.0 - x * (1.0 / 5.0)))));
    }
    return 1.0 - binary_exponential(-(x < most ? x : most) * (1.0 / ln2));
  }
};

}  // namespace fexp::physics
