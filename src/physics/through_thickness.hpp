// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace fexp::physics {

/// Most integration points through a thickness.
inline constexpr int most_points = 9;
/// Fewest points of Lobatto's rule: with two, on the surfaces, a plate would be three times too stiff in bending.
inline constexpr int fewest_lobatto_points = 3;

enum class Quadrature { gauss, lobatto };

/// Integration points through the thickness, from the lower to the upper side of [-1, 1], with weights whose sum is 1.
struct ThroughThickness {
  int count{};
  std::array<double, most_points> position{};  // [-]
  std::array<double, most_points> weight{};    // [-]
};

namespace detail {

struct Legendre {
  double value, slope;
};

/// Legendre's polynomial of a degree from 1 on and its derivative where |x| < 1 (M. Abramowitz, I. Stegun, Handbook of
/// Mathematical Functions, 22.7.10 and 22.8.5).
[[nodiscard]] inline Legendre legendre(int degree, double x) noexcept {
  double before = 1.0, value = x;
  for (int k = 2; k <= degree; ++k) {
    const double next = ((2 * k - 1) * (x * value) - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, degree * (x * value - before) / (x * x - 1.0)};
}

/// The only zero between a and b, by halving to the last bit.
template <class Function>
[[nodiscard]] double zero_between(double a, double b, const Function& function) noexcept {
  // Not at the ends, where a derivative may not be finite.
  const double outside = function(a + 1.0e-9 * (b - a));
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (a + b);
    (function(middle) * outside > 0.0 ? a : b) = middle;
  }
  return 0.5 * (a + b);
}

/// The zeros of Legendre's polynomial, ascending: between each two neighbours there is one of the next degree.
[[nodiscard]] inline std::array<double, most_points> legendre_zeros(int degree) noexcept {
  std::array<double, most_points> zeros{};
  for (int d = 1; d <= degree; ++d) {
    double low = -1.0;
    for (int i = 0; i < d; ++i) {
      const double high = i + 1 < d ? zeros[static_cast<std::size_t>(i)] : 1.0;
      zeros[static_cast<std::size_t>(i)] = zero_between(low, high, [d](double x) { return legendre(d, x).value; });
      low = high;
    }
  }
  return zeros;
}

}  // namespace detail

/// Gauss's rule with 1 to 9 points, or Lobatto's with 3 to 9, which has points on both surfaces; exact for polynomials
/// of degree 2 count - 1 and 2 count - 3 (Abramowitz and Stegun, 25.4.29 and 25.4.32).
[[nodiscard]] inline ThroughThickness through_thickness(Quadrature rule, int count) noexcept {
  ThroughThickness points;
  points.count = count;
  const bool lobatto = rule == Quadrature::lobatto;
  const int degree = lobatto ? count - 1 : count;
  const std::array<double, most_points> zeros = detail::legendre_zeros(degree);
  for (int i = 0; i < (count + 1) / 2; ++i) {
    const auto low = static_cast<std::size_t>(i), high = static_cast<std::size_t>(count - 1 - i);
    double x = -1.0;
    if (low == high) {
      x = 0.0;
    } else if (!lobatto) {
      x = zeros[low];
    } else if (i > 0) {
      // Extrema lie between zeros.
      x = detail::zero_between(zeros[low - 1], zeros[low],
                               [degree](double y) { return detail::legendre(degree, y).slope; });
    }
    const detail::Legendre p = detail::legendre(degree, x);
    points.position[high] = -x;
    points.position[low] = x;
    points.weight[low] = points.weight[high] =
        lobatto ? 1.0 / (count * (count - 1) * p.value * p.value) : 1.0 / ((1.0 - x * x) * p.slope * p.slope);
  }
  return points;
}

}  // namespace fexp::physics
