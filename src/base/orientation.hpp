// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vec3.hpp"

/// Signs of determinants of coordinates without an error of rounding, as long as no product of three of them overflows
/// or underflows [Sh97: J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates, Discrete & Computational Geometry 18 (1997) 305-363]. The value in doubles decides where its error bound
/// lets it; else sums of doubles without rounding do.
namespace fexp {

/// Sign of dot(cross(b - a, c - a), d - a): 1 where d is on the side that the normal of triangle a b c points to, -1 on
/// the other, 0 in its plane.
[[nodiscard]] int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

/// The same of a d that is moved by (e, e^2, e^3) with an infinitely small e > 0: 0 only where a, b and c are in line.
[[nodiscard]] int moved_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

/// Sign of dot(cross(q - p, a - p), b - p) of a p and a q that are both moved so: to which side the line p q passes the
/// line a b. 0 only where the lines are parallel.
[[nodiscard]] int moved_passing(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b);

}  // namespace fexp
