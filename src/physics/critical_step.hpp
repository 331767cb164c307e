// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "physics/c0_triangle.hpp"

namespace fexp::physics {

/// Largest eigenvalue of C (B B^T) for the membrane of a triangle: Newton's method on the characteristic polynomial,
/// started above all roots, so that every iterate is an upper bound. `bb`, `cc`, `bc` are the sums of b_i^2, c_i^2 and
/// b_i c_i over the corners [1/length^2]; the result is [force/length^4].
[[nodiscard]] inline double membrane_eigenvalue(const PlaneStressModuli& m, double bb, double cc, double bc) noexcept {
  // Rows of C (B B^T) with B B^T = [[bb, 0, bc], [0, cc, bc], [bc, bc, bb + cc]].
  const std::array<std::array<double, 3>, 3> a = {{{m.direct * bb, m.cross * cc, (m.direct + m.cross) * bc},
                                                   {m.cross * bb, m.direct * cc, (m.direct + m.cross) * bc},
                                                   {m.shear * bc, m.shear * bc, m.shear * (bb + cc)}}};
  const double i1 = a[0][0] + a[1][1] + a[2][2];
  const double i2 = (a[0][0] * a[1][1] - a[0][1] * a[1][0]) + (a[0][0] * a[2][2] - a[0][2] * a[2][0]) +
                    (a[1][1] * a[2][2] - a[1][2] * a[2][1]);
  const double i3 = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                    a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                    a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  double lambda = i1;
  for (int iteration = 0; iteration < 40; ++iteration) {
    const double value = ((lambda - i1) * lambda + i2) * lambda - i3;
    const double slope = (3.0 * lambda - 2.0 * i1) * lambda + i2;
    const double next = lambda - value / slope;
    if (!(next < lambda)) {
      break;
    }
    lambda = next;
  }
  return lambda;
}

/// Upper bound of the squared highest frequency of a free element [1/time^2]: the larger of membrane plus drilling tie,
/// and bending plus transverse shear. It equals the exact eigenvalue of the 18 degrees of freedom for thin elements and
/// exceeds its root by less than 3 % up to t = 0.3 sqrt(A), whatever the shape.
[[nodiscard]] inline double element_frequency_bound(const ShellSection& s, double density,
                                                    const TriangleFrame<double>& f) noexcept {
  const double area = 0.5 * f.doubled_area;
  const ShapeDerivatives<double> d(f);
  const double b1 = -d.b2, c1 = -(d.c2 + d.c3);
  const double bb = b1 * b1 + d.b2 * d.b2;
  const double cc = c1 * c1 + d.c2 * d.c2 + d.c3 * d.c3;
  const double bc = b1 * c1 + d.b2 * d.c2;
  const double t2 = s.thickness * s.thickness;
  const double radius2 = area / 4.5 + t2 / 12.0;  // rotary inertia over mass
  const double corner = corner_mass(density, s.thickness, area);

  const double membrane = 3.0 / density * membrane_eigenvalue(s.moduli, bb, cc, bc);
  const double drill = drilling_stiffness(s, area) * (1.0 / radius2 + 0.75 * (bb + cc)) / corner;

  const AssumedShear<double> shear_terms(f, d);
  const std::array<double, 6> row_xz = shear_terms.row_xz(), row_yz = shear_terms.row_yz();
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < 6; ++i) {
    xx += row_xz[i] * row_xz[i];
    yy += row_yz[i] * row_yz[i];
    xy += row_xz[i] * row_yz[i];
  }
  const double scale = 1.0 / (36.0 * radius2);
  xx = bb + scale * xx;
  yy = cc + scale * yy;
  xy = bc + scale * xy;
  const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
  const double shear =
      3.0 / density * ShellSection::shear_factor * s.moduli.shear * (mean + square_root(half * half + xy * xy));
  const double bending = membrane * (t2 / 12.0) / radius2;
  return std::max(membrane + drill, bending + shear);
}

/// Critical step 2/omega of central differences for a free element [time].
[[nodiscard]] inline double element_critical_step(const ShellSection& s, double density,
                                                  const TriangleFrame<double>& f) noexcept {
  return 2.0 / square_root(element_frequency_bound(s, density, f));
}

}  // namespace fexp::physics
