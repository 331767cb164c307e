// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <initializer_list>

#include "base/vec3.hpp"

namespace fexp::physics {

/// Where the lines through two edges are closest to each other. Parameters run from 0 to 1 along each edge.
struct ClosestOnLines {
  double first{};
  double second{};
  Vec3d normal;    ///< First edge x second edge [length^2]
  double sine2{};  ///< Squared sine of the angle between them; 0 where they are parallel or have no length
  double gap{};    ///< From the first line to the second along the unit normal [length]
};

/// Of the edges a0 a1 and b0 b1.
[[nodiscard]] inline ClosestOnLines closest_on_lines(const Vec3d& a0, const Vec3d& a1, const Vec3d& b0,
                                                     const Vec3d& b1) noexcept {
  const Vec3d along_a = a1 - a0, along_b = b1 - b0, between = b0 - a0;
  ClosestOnLines c;
  c.normal = cross(along_a, along_b);
  const double normal2 = dot(c.normal, c.normal);
  const double lengths2 = dot(along_a, along_a) * dot(along_b, along_b);
  if (!(normal2 > 0.0) || !(lengths2 > 0.0)) {
    return c;
  }
  const double inverse = 1.0 / normal2;
  c.sine2 = normal2 / lengths2;
  c.first = dot(cross(between, along_b), c.normal) * inverse;
  c.second = dot(cross(between, along_a), c.normal) * inverse;
  c.gap = dot(between, c.normal) / norm(c.normal);
  return c;
}

/// Square of the distance between the edges a0 a1 and b0 b1, whose lines are closest at `c` [length^2]: at the closest
/// points of the lines where these lie on the edges, otherwise from an end of one of them to the other one.
[[nodiscard]] inline double edge_distance2(const Vec3d& a0, const Vec3d& a1, const Vec3d& b0, const Vec3d& b1,
                                           const ClosestOnLines& c) noexcept {
  const auto from_end = [](const Vec3d& p, const Vec3d& begin, const Vec3d& end) {
    const Vec3d along = end - begin, from = p - begin;
    const double along2 = dot(along, along);
    double part = along2 > 0.0 ? dot(from, along) / along2 : 0.0;
    part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
    const Vec3d offset = from - part * along;
    return dot(offset, offset);
  };
  double least = from_end(a0, b0, b1);
  for (const double other : {from_end(a1, b0, b1), from_end(b0, a0, a1), from_end(b1, a0, a1)}) {
    least = other < least ? other : least;
  }
  const bool on_both = c.sine2 > 0.0 && c.first >= 0.0 && c.first <= 1.0 && c.second >= 0.0 && c.second <= 1.0;
  return on_both && c.gap * c.gap < least ? c.gap * c.gap : least;
}
[[nodiscard]] inline double edge_distance2(const Vec3d& a0, const Vec3d& a1, const Vec3d& b0,
                                           const Vec3d& b1) noexcept {
  return edge_distance2(a0, a1, b0, b1, closest_on_lines(a0, a1, b0, b1));
}

/// How far ends of the edges must move relative to each other, at least, before the lines can be closest within both of
/// them at an angle whose squared sine is more than `least_sine2` [length]; 0 where they are already.
///
/// With arc lengths q = (u, v) from a0 and b0, unit vectors e, f along the edges and w = b0 - a0, the lines are closest
/// where M q = r, M = [1 -e.f; -e.f 1], r = (e.w, -f.w). After a motion m the unit vectors differ by d <= m / (shorter
/// edge - m) each, e.f by 2 d at most, r by d |w| + m; and a solution within both edges is no larger than the longer
/// edge
/// + m. So |M^-1| = 1 / (1 - |e.f|) bounds by how much q can have changed, and it has to come from where it is to
/// where an edge ends then.
[[nodiscard]] inline double motion_before_crossing(const Vec3d& a0, const Vec3d& a1, const Vec3d& b0, const Vec3d& b1,
                                                   const ClosestOnLines& c, double least_sine2) noexcept {
  const double a = norm(a1 - a0), b = norm(b1 - b0);
  const double shorter = a < b ? a : b, longer = a < b ? b : a;
  constexpr double most_part = 0.1;  // Of the shorter edge, up to which the bounds below are meant
  const double most = most_part * shorter, by_turn = 1.0 / ((1.0 - most_part) * shorter);
  const auto within_most = [most](double motion) { return motion < most ? motion : most; };
  if (!(shorter > 0.0)) {
    return 0.0;
  }
  if (!(c.sine2 > least_sine2)) {
    // An angle is no less than its sine, and changes by no more than pi/2 times both d.
    constexpr double half_pi = 1.5707963267948966;
    return within_most((std::sqrt(least_sine2) - std::sqrt(c.sine2)) / (2.0 * half_pi * by_turn));
  }
  const auto beyond = [](double part, double length) {
    const double behind = -part * length, ahead = (part - 1.0) * length;
    return behind > ahead ? behind : ahead;
  };
  const double of_a = beyond(c.first, a), of_b = beyond(c.second, b);
  const double outside = of_a > of_b ? of_a : of_b;
  if (!(outside > 0.0)) {
    return 0.0;
  }
  const double cosine = std::sqrt(c.sine2 < 1.0 ? 1.0 - c.sine2 : 0.0);
  const double by_motion = 1.0 + by_turn * (2.0 * (1.0 + most_part) * longer + norm(b0 - a0));
  return within_most(outside / (1.0 + by_motion / (1.0 - cosine)));
}

}  // namespace fexp::physics
