// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/inline.hpp"
#include "base/pack.hpp"

/// Logarithm, exponential and power for use inside the step, of doubles or packs. They consist of + - * / and changes
/// of exponents alone, so that compilers, processors and widths of packs give the same bits; those of the C library do
/// not. Relative errors are below 2e-12: material laws are not known better, and each term less is time.
namespace fexp {

inline constexpr double ln2 = 0.6931471805599453;

/// Logarithm to base 2 of positive normal numbers: e + 2/ln 2 artanh s, s = (f - 1)/(f + 1) for x = f 2^e, by the
/// series of artanh up to s^13; |s| < 0.172.
template <class T>
[[nodiscard]] FEXP_INLINE T binary_log(const T& x) noexcept {
  T exponent(0.0);
  const T fraction = split_exponent(x, exponent);
  const T s = (fraction - T(1.0)) / (fraction + T(1.0));
  const T z = s * s, z2 = z * z, z4 = z2 * z2;
  // 2/ln 2/(2 k + 1); pairs of terms side by side, as the chain of operations that wait for each other takes time.
  const T a = T(0.9617966939259756) + T(0.5770780163555853) * z, b = T(0.4121985831111324) + T(0.3205988979753252) * z;
  const T c = T(0.2623081892525388) + T(0.22195308321368667) * z;
  return exponent + s * (T(2.8853900817779268) + z * ((a + b * z2) + c * z4));
}

/// 2^x for x from -1000 to 1000: 2^k 2^r with |r| <= 1/2, by the series of 2^r up to r^10.
template <class T>
[[nodiscard]] FEXP_INLINE T binary_exponential(const T& x) noexcept {
  // A sum with 1.5 x 2^52 rounds to a whole number.
  constexpr double rounding = 1.5 * detail::two_to_52;
  const T k = (x + T(rounding)) - T(rounding);
  const T r = x - k, r2 = r * r, r4 = r2 * r2;
  // (ln 2)^i/i!
  const T a = T(1.0) + T(0.6931471805599453) * r, b = T(0.24022650695910072) + T(0.05550410866482158) * r;
  const T c = T(0.009618129107628477) + T(0.0013333558146428443) * r;
  const T d = T(0.0001540353039338161) + T(1.5252733804059841e-05) * r;
  const T e = T(1.321548679014431e-06) + T(1.01780860092397e-07) * r;
  const T f = T(7.054911620801123e-09);
  const T high = (c + d * r2) + r4 * (e + f * r2);
  return times_power_of_two((a + b * r2) + r4 * high, k);
}

/// x^n for normal positive x, where it is from 1e-300 to 1e300.
template <class T>
[[nodiscard]] FEXP_INLINE T power(const T& x, double n) noexcept {
  return binary_exponential(T(n) * binary_log(x));
}

}  // namespace fexp
