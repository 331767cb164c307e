// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fexp::bench {

/// Chains of operations that do not wait for each other, as many as keep every unit of a processor busy. Returns a
/// number that all of them go into, so that none may be left out.
using ArithmeticLoop = double (*)(std::int64_t rounds, double factor, double summand) noexcept;

/// a[i] = b[i] + s c[i] for i < count.
using TriadLoop = void (*)(double* a, const double* b, const double* c, double s, std::size_t count) noexcept;

/// Loops that do nothing but arithmetic or memory traffic, compiled for one instruction set.
struct ArithmeticKernels {
  ArithmeticLoop fused{};     ///< Fused multiply-adds, of two flops each; null where the instruction set has none
  ArithmeticLoop separate{};  ///< As many multiplications as additions, not fused, as the element kernel has them
  double fused_flops{};       ///< Of one round
  double separate_flops{};    ///< Of one round
  TriadLoop triad{};
};

/// Those of the instruction set of an element kernel, by its name: "avx512", "avx2" or anything else for the baseline.
[[nodiscard]] ArithmeticKernels arithmetic_kernels(std::string_view element_kernel) noexcept;

}  // namespace fexp::bench
