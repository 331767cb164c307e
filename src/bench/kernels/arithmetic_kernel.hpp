// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/pack.hpp"
#include "bench/arithmetic.hpp"

namespace fexp::bench::kernels {

/// An operation takes four cycles at most and a processor begins four in a cycle at most, so that about sixteen chains
/// keep it busy; with two operands that all share they are to fit into sixteen registers.
inline constexpr int fused_chains = 12;
inline constexpr int separate_chains = 7;  // Of each kind

/// x = x factor + summand.
template <class Lanes>
double fused_rounds(std::int64_t rounds, double factor, double summand) noexcept {
  const Lanes f(factor), s(summand);
  std::array<Lanes, fused_chains> x;
  for (int i = 0; i < fused_chains; ++i) {
    x[std::size_t(i)] = Lanes(i);
  }
  for (std::int64_t r = 0; r < rounds; ++r) {
#pragma GCC unroll 16
    for (Lanes& one : x) {
      one = fused_multiply_add(one, f, s);
    }
  }
  Lanes sum(0.0);
  for (const Lanes& one : x) {
    sum += one;
  }
  return sum.lane(0);
}

/// x = x factor and y = y + summand.
template <class Lanes>
double separate_rounds(std::int64_t rounds, double factor, double summand) noexcept {
  const Lanes f(factor), s(summand);
  std::array<Lanes, separate_chains> x, y;
  for (int i = 0; i < separate_chains; ++i) {
    x[std::size_t(i)] = y[std::size_t(i)] = Lanes(i);
  }
  for (std::int64_t r = 0; r < rounds; ++r) {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < separate_chains; ++i) {
      x[i] = x[i] * f;
      y[i] = y[i] + s;
    }
  }
  Lanes sum(0.0);
  for (std::size_t i = 0; i < separate_chains; ++i) {
    sum += x[i] + y[i];
  }
  return sum.lane(0);
}

template <class Lanes>
void triad(double* a, const double* b, const double* c, double s, std::size_t count) noexcept {
  constexpr auto width = static_cast<std::size_t>(Lanes::width);
  const Lanes factor(s);
  std::size_t i = 0;
  for (; i + width <= count; i += width) {
    (Lanes::load(b + i) + factor * Lanes::load(c + i)).store(a + i);
  }
  for (; i < count; ++i) {
    a[i] = b[i] + s * c[i];
  }
}

/// The loops over packs that have fused_multiply_add.
template <class Lanes>
ArithmeticKernels arithmetic_of() noexcept {
  constexpr double lanes = Lanes::width;
  return {fused_rounds<Lanes>, separate_rounds<Lanes>, 2.0 * fused_chains * lanes, 2.0 * separate_chains * lanes,
          triad<Lanes>};
}

[[nodiscard]] ArithmeticKernels arithmetic_baseline() noexcept;
[[nodiscard]] ArithmeticKernels arithmetic_avx2() noexcept;
[[nodiscard]] ArithmeticKernels arithmetic_avx512() noexcept;

}  // namespace fexp::bench::kernels
