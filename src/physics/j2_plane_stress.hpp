// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "physics/layered_section.hpp"

/// Return to von Mises's yield surface in plane stress, implicit in the step: J. C. Simo, R. L. Taylor, A return
/// mapping algorithm for plane stress elastoplasticity, IJNME 22 (1986) 649-670 [ST86], with isotropic hardening.
namespace fexp::physics {

/// A plane tensor by what a return to the yield surface scales: the sum xx + yy, the difference xx - yy and the shear
/// xy. Of strains the shear is the engineering one.
template <class T>
struct PlaneTensor {
  T sum, difference, shear;
};

/// How the trial stress becomes the stress on the yield surface.
template <class T>
struct J2Return {
  T mean_factor;        ///< Of sxx + syy; exactly 1 where nothing yields [-]
  T deviator_factor;    ///< Of sxx - syy and of sxy; likewise [-]
  T strain;             ///< Increment of the effective plastic strain [-]
  T stress;             ///< Von Mises stress afterwards, 0 where nothing yields [force/length^2]
  T transverse_strain;  ///< Increment of the plastic strain across the thickness, over sxx + syy afterwards
};

/// Newton's steps before halving takes over; with it no return takes more than `most_return_steps`.
inline constexpr int most_newton_steps = 20;
inline constexpr int most_return_steps = 80;

/// Largest error of y at which a search ends; where Y has corners, the largest last step.
inline constexpr double largest_error = 3.0e-10;
inline constexpr double corner_error = 1.0e-11;

/// The search for y = 3 G dep/q that solves q(y) = Y(ep + y q(y)/3G), where q(y)^2 = a/(1 + ratio y)^2 + b/(1 + y)^2
/// [ST86 eq. 3.11]: Newton's method on f = Y/q - 1, which is almost linear in y, kept inside a bracket of the solution.
/// Each lane ends by itself, so that none depends on the others.
template <class T>
struct J2Search {
  T a, b;           // Squares of the trial stress [force^2/length^4]
  T stress, slope;  // Y and its derivative at the y before
  T y, low, high;   // The bracket holds the solution
  T way;            // Length of the last step
  T pending;        // 1 while y is not found, else 0

  /// Takes the first step, from y = 0, where Y and its derivative are `stress` and `slope`. It goes to the second order
  /// in y, less the curvature of Y: f'' = -3 Y/q a b (1 - ratio)^2/q^4.
  [[nodiscard]] FEXP_INLINE static J2Search started(const J2Elasticity& c, const T& a, const T& b, const T& stress,
                                                    const T& slope) noexcept {
    const T square = a + b, root = square_root(square);
    const T quotient = T(1.0) / (root * stress);
    const T inverse_q = stress * quotient, inverse_square = inverse_q * inverse_q;
    const T share = stress * inverse_q;
    const T derivative = slope * T(c.compliance) + share * ((T(c.ratio) * a + b) * inverse_square);
    const T inverse_derivative = T(1.0) / derivative;
    const T newton = (T(1.0) - share) * inverse_derivative;
    const T bent = T(c.spread) * share * ((a * inverse_square) * (b * inverse_square)) * inverse_derivative;
    // With no hardening and the weaker of both returns alone the surface is reached at the upper end.
    const T high = (square * quotient - T(1.0)) * T(c.inverse_ratio);
    const T pending = select_less(stress * stress, square, T(1.0), T(0.0));
    const T y = select_less(T(0.5), pending, minimum(newton + bent * (newton * newton), high), T(0.0));
    return {a, b, stress, slope, y, T(0.0), high, y, pending};
  }

  /// One step more. `yield.after(increment, slope)` is Y for an increment dep, smooth or with corners.
  template <bool Smooth, class Yield>
  FEXP_INLINE void advance(const J2Elasticity& c, int step, const Yield& yield) noexcept {
    const T ratio(c.ratio), inverse(c.compliance), one(1.0), half(0.5);
    const T d1 = one + ratio * y, d2 = one + y;
    const T product = d1 * d2, mean = a * (d2 * d2), deviator = b * (d1 * d1);
    const T root = square_root(mean + deviator);
    const T quotient = one / (root * product);
    const T inverse_product = root * quotient, inverse_root = product * quotient;
    const T q = root * inverse_product, inverse_q = product * inverse_root;
    const T slope_before = slope;
    stress = yield.after(y * (q * inverse), slope);
    const T share = stress * inverse_q, excess = share - one;
    // -q'/q, with d2/product for 1/d1 and d1/product for 1/d2
    const T fall = (ratio * (mean * d2) + deviator * d1) * (inverse_product * (inverse_root * inverse_root));
    const T derivative = slope * inverse * (one - y * fall) + share * fall;
    low = select_less(excess, T(0.0), y, low);
    high = select_less(excess, T(0.0), high, y);
    const T middle = half * (low + high), newton = y - excess / derivative;
    const T next = step < most_newton_steps ? select_less(newton, low, middle, minimum(newton, high)) : middle;
    const T change = next - y, size = maximum(change, -change);
    y = select_less(half, pending, next, y);
    if constexpr (Smooth) {
      // What a step of Newton's leaves is half its square times f''/f', of which the change of the slope over the last
      // step tells the one part, and spread/4/ratio bounds the other.
      const T bend = maximum(slope_before - slope, slope - slope_before) * inverse;
      const T left = size * size * (bend + T(0.25 * c.spread * c.inverse_ratio) * way);
      const T astray = maximum(next - newton, newton - next);
      const T unfinished = select_less(left, T(largest_error) * way, T(0.0), one);
      pending = select_less(half, pending, select_less(T(largest_error), astray, one, unfinished), T(0.0));
      way = size;
    } else {
      const T error = maximum(size, maximum(excess, -excess));
      pending = select_less(T(corner_error) * d2, error, pending, T(0.0));
    }
  }

  [[nodiscard]] FEXP_INLINE J2Return<T> result(const J2Elasticity& c) const noexcept {
    const T d1 = T(1.0) + T(c.ratio) * y, d2 = T(1.0) + y;
    const T inverse = T(1.0) / (d1 * d2);
    const T u1 = d2 * inverse, u2 = d1 * inverse;
    const T q = square_root(a * (u1 * u1) + b * (u2 * u2));
    const T multiplier = y * T(c.compliance);
    return {u1, u2, multiplier * q, select_less(T(0.0), y, q, T(0.0)), T(-0.5) * multiplier};
  }
};

/// Returns a trial stress to the yield surface. `yield_stress()` is asked for the yield stress, which is nowhere less
/// than `least_stress`, where that is exceeded: a value with its `stress` and `slope` at the step's start, and
/// `after(increment, slope)` for an increment of the effective plastic strain; without corners where `Smooth`.
template <bool Smooth, class T, class Yield>
[[nodiscard]] FEXP_INLINE J2Return<T> return_to_yield(const J2Elasticity& c, const PlaneTensor<T>& trial,
                                                      const T& least_stress, const Yield& yield_stress) noexcept {
  const J2Return<T> nothing{T(1.0), T(1.0), T(0.0), T(0.0), T(0.0)};
  const T a = T(0.25) * (trial.sum * trial.sum);
  const T b = T(0.75) * (trial.difference * trial.difference) + T(3.0) * (trial.shear * trial.shear);
  if (!any_less(least_stress * least_stress, a + b)) {
    return nothing;
  }
  const auto yield = yield_stress();
  if (!any_less(yield.stress * yield.stress, a + b)) {
    return nothing;
  }
  J2Search<T> search = J2Search<T>::started(c, a, b, yield.stress, yield.slope);
  for (int step = 1; step < most_return_steps && any_less(T(0.5), search.pending); ++step) {
    search.template advance<Smooth>(c, step, yield);
  }
  return search.result(c);
}

}  // namespace fexp::physics
