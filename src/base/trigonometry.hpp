// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// Sine, cosine and tangent for setting a model up. The C library's own for double differ in the last bit between
/// processors with and without fused multiply-add; those for long double are the same on every x86-64 processor.
namespace fexp {

[[nodiscard]] inline double sine(double angle) noexcept {
  return static_cast<double>(std::sin(static_cast<long double>(angle)));
}
[[nodiscard]] inline double cosine(double angle) noexcept {
  return static_cast<double>(std::cos(static_cast<long double>(angle)));
}
[[nodiscard]] inline double tangent(double angle) noexcept {
  return static_cast<double>(std::tan(static_cast<long double>(angle)));
}

}  // namespace fexp
