// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "physics/hardening.hpp"

/// Hardening curves about the effective plastic strain at a step's start: the yield stress and its slope there, and
/// again for the increments that a return tries.
namespace fexp::physics {

template <class T, class Curve>
struct YieldStress {
  const Curve& curve;
  T strain;
  T stress;  ///< At `strain` [force/length^2]
  T slope;   ///< Likewise

  FEXP_INLINE YieldStress(const Curve& of, const T& at) noexcept : curve(of), strain(at), stress(0.0), slope(0.0) {
    stress = curve.at(strain, slope);
  }
  [[nodiscard]] FEXP_INLINE T after(const T& increment, T& derivative) const noexcept {
    return curve.at(strain + increment, derivative);
  }
};

/// (1 + x)^(n - 1) by its series where x = increment/strain is small: a third of the time of another power.
template <class T>
struct YieldStress<T, PowerHardening> {
  static constexpr std::size_t terms = 8;
  /// The first term left out is below 3e-13 there.
  static constexpr double largest_part = 0.04;

  const PowerHardening& curve;
  T strain;
  T stress;  ///< At `strain` [force/length^2]
  T slope;   ///< Likewise
  T secant;  ///< (stress - a)/strain
  T inverse_strain;
  std::array<double, terms> binomial;

  FEXP_INLINE YieldStress(const PowerHardening& of, const T& at) noexcept
      : curve(of), strain(at), stress(0.0), slope(0.0), secant(0.0), inverse_strain(0.0), binomial() {
    const T least(PowerHardening::least_strain), not_less = maximum(strain, least);
    secant = T(curve.b) * power(not_less, curve.n - 1.0);
    inverse_strain = T(1.0) / not_less;
    slope = select_less(strain, least, secant, T(curve.n) * secant);
    stress = T(curve.a) + secant * strain;
    double coefficient = 1.0;
    for (std::size_t k = 0; k < terms; ++k) {
      const auto order = static_cast<double>(k + 1);
      coefficient = coefficient * ((curve.n - order) / order);
      binomial[k] = coefficient;
    }
  }
  [[nodiscard]] FEXP_INLINE T after(const T& increment, T& derivative) const noexcept {
    const T x = increment * inverse_strain, x2 = x * x, x4 = x2 * x2, one(1.0);
    const T a = one + T(binomial[0]) * x, b = T(binomial[1]) + T(binomial[2]) * x;
    const T c = T(binomial[3]) + T(binomial[4]) * x, d = T(binomial[5]) + T(binomial[6]) * x;
    const T now = strain + increment;
    const T near = secant * ((a + b * x2) + x4 * ((c + d * x2) + T(binomial[7]) * x4));
    const T value = T(curve.a) + near * now, small_slope = T(curve.n) * near;
    // Strains below the least one, where the curve is a chord, have no series.
    const T far = select_less(strain, T(PowerHardening::least_strain), one, x);
    if (!any_less(T(largest_part), far)) {
      derivative = small_slope;
      return value;
    }
    T other_slope(0.0);
    const T other = curve.at(now, other_slope);
    derivative = select_less(T(largest_part), far, other_slope, small_slope);
    return select_less(T(largest_part), far, other, value);
  }
};

}  // namespace fexp::physics
