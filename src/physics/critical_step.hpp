// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "physics/c0_triangle.hpp"

namespace fexp::physics {

/// Largest eigenvalue of C (B B^T) for the membrane of a triangle: Newton's method on the characteristic polynomial,
/// started above all roots, so that every iterate is an upper bound. `bb`, `cc`, `bc` are the sums of b_i^2, c_i^2 and
/// b_i c_i over the corners [1/length^2]; the result is [force/length^4].
template <class T>
[[nodiscard]] inline T membrane_eigenvalue(const PlaneStressModuli& m, const T& bb, const T& cc, const T& bc) noexcept {
  // Rows of C (B B^T) with B B^T = [[bb, 0, bc], [0, cc, bc], [bc, bc, bb + cc]].
  const T direct(m.direct), cross(m.cross), shear(m.shear), mixed(m.direct + m.cross);
  const std::array<std::array<T, 3>, 3> a = {{{direct * bb, cross * cc, mixed * bc},
                                              {cross * bb, direct * cc, mixed * bc},
                                              {shear * bc, shear * bc, shear * (bb + cc)}}};
  const T i1 = a[0][0] + a[1][1] + a[2][2];
  const T i2 = (a[0][0] * a[1][1] - a[0][1] * a[1][0]) + (a[0][0] * a[2][2] - a[0][2] * a[2][0]) +
               (a[1][1] * a[2][2] - a[1][2] * a[2][1]);
  const T i3 = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  T lambda = i1;
  for (int iteration = 0; iteration < 40; ++iteration) {
    const T value = ((lambda - i1) * lambda + i2) * lambda - i3;
    const T slope = (T(3.0) * lambda - T(2.0) * i1) * lambda + i2;
    const T next = minimum(lambda - value / slope, lambda);
    if (all_equal(next, lambda)) {
      break;
    }
    lambda = next;
  }
  return lambda;
}

/// What the bound of an element's frequency takes from its shape.
template <class T>
struct BoundShape {
  ShapeDerivatives<T> d;
  T bb, cc, bc;  // Sums of b_i^2, c_i^2 and b_i c_i over the corners [1/length^2]
  T eigenvalue;  // Of C (B B^T) [force/length^4]
  T area;        // [length^2]
  AssumedShear<T> shear;

  FEXP_INLINE BoundShape(const PlaneStressModuli& moduli, const TriangleFrame<T>& f) noexcept
      : d(f), bb(), cc(), bc(), eigenvalue(), area(T(0.5) * f.doubled_area), shear(f, d) {
    const T b1 = -d.b2, c1 = -(d.c2 + d.c3);
    bb = b1 * b1 + d.b2 * d.b2;
    cc = c1 * c1 + d.c2 * d.c2 + d.c3 * d.c3;
    bc = b1 * c1 + d.b2 * d.c2;
    eigenvalue = membrane_eigenvalue(moduli, bb, cc, bc);
  }
};

/// Stiffnesses and inertias of an element as the bound of its frequency needs them.
template <class T>
struct BoundTerms {
  T membrane;  ///< What the eigenvalue is multiplied by: 3/rho, or what has become of it [length^3/mass]
  T shear;     ///< Likewise that of the transverse shear [length^2/time^2]
  T bending2;  ///< Stiffness of bending over that of the membrane, t^2/12 [length^2]
  T drilling;  ///< k_d [force*length]
  T corner;    ///< Mass of a corner [mass]
  T radius2;   ///< Its rotary inertia over its mass [length^2]
};

/// Upper bound of the squared highest frequency of a free element [1/time^2]: the larger of membrane plus drilling tie,
/// and bending plus transverse shear. It equals the exact eigenvalue of the 18 degrees of freedom for thin elements and
/// exceeds its root by less than 3 % up to t = 0.3 sqrt(A), whatever the shape.
template <class T>
[[nodiscard]] FEXP_INLINE T frequency_bound(const BoundShape<T>& shape, const BoundTerms<T>& terms) noexcept {
  const T& radius2 = terms.radius2;
  const T membrane = terms.membrane * shape.eigenvalue;
  const T drill = terms.drilling * (T(1.0) / radius2 + T(0.75) * (shape.bb + shape.cc)) / terms.corner;

  const std::array<T, 6> row_xz = shape.shear.row_xz(), row_yz = shape.shear.row_yz();
  T xx(0.0), yy(0.0), xy(0.0);
  for (std::size_t i = 0; i < 6; ++i) {
    xx = xx + row_xz[i] * row_xz[i];
    yy = yy + row_yz[i] * row_yz[i];
    xy = xy + row_xz[i] * row_yz[i];
  }
  const T scale = T(1.0) / (T(36.0) * radius2);
  xx = shape.bb + scale * xx;
  yy = shape.cc + scale * yy;
  xy = shape.bc + scale * xy;
  const T mean = T(0.5) * (xx + yy), half = T(0.5) * (xx - yy);
  const T shear = terms.shear * (mean + square_root(half * half + xy * xy));
  const T bending = membrane * terms.bending2 / radius2;
  // In this order a sum that is not a number is the result.
  return maximum(bending + shear, membrane + drill);
}

/// Critical step 2/omega of central differences for a free element of constant thickness, with the mass that its
/// present geometry has [time].
template <class T>
[[nodiscard]] inline T element_critical_step(const ShellSection& s, double density,
                                             const TriangleFrame<T>& f) noexcept {
  const BoundShape<T> shape(s.moduli, f);
  const T& area = shape.area;
  const double t2 = s.thickness * s.thickness;
  const BoundTerms<T> terms{T(3.0 / density),
                            T(3.0 / density * ShellSection::shear_factor * s.moduli.shear),
                            T(t2 / 12.0),
                            drilling_stiffness(s, area),
                            T(density * s.thickness) * area / T(3.0),
                            area / T(4.5) + T(t2 / 12.0)};
  return T(2.0) / square_root(frequency_bound(shape, terms));
}

/// The same where the section has points: membrane and bending have the present thickness, transverse shear and
/// drilling that of the deck, and the mass is that of the reference geometry, which has the area `reference_area`. In
/// the reference geometry it is that of above to the bit.
template <class T>
[[nodiscard]] inline T layered_critical_step(const ShellSection& s, double density, const T& thickness,
                                             const T& reference_area, const TriangleFrame<T>& f) noexcept {
  const BoundShape<T> shape(s.moduli, f);
  const T thickness2 = thickness * thickness, spread = shape.area / reference_area;
  const BoundTerms<T> terms{T(3.0 / density) * (spread * (thickness / T(s.thickness))),
                            T(3.0 / density * ShellSection::shear_factor * s.moduli.shear) * spread,
                            thickness2 / T(12.0),
                            drilling_stiffness(s, shape.area),
                            T(density * s.thickness) * reference_area / T(3.0),
                            reference_area / T(4.5) + T(s.thickness * s.thickness / 12.0)};
  return T(2.0) / square_root(frequency_bound(shape, terms));
}

/// The omega for which 2/omega is the critical step of central differences whose stiffness damping, with coefficient
/// beta [time], takes the velocity of mid-step: with the bounds of omega^2 of what is damped and of what is not,
///     (damped2 + other2) dt^2/4 + beta damped2 dt/2 <= 1,
/// as then M - dt^2/4 K - dt/2 beta K_damped has no negative eigenvalue and an energy of the scheme is positive. For
/// one mode that is dt = 2/omega (sqrt(1 + xi^2) - xi) with xi = beta omega/2 [BLM00, sec. 6.2].
[[nodiscard]] inline double damped_frequency(double damped2, double other2, double beta) noexcept {
  const double half = beta > 0.0 ? 0.5 * beta * damped2 : 0.0;  // A collapsed element has no finite frequency
  return half + std::sqrt(half * half + (damped2 + other2));
}

}  // namespace fexp::physics
