// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Square of the distance between the edges a0 a1 and b0 b1 [length^2]: at the closest points of the lines where these
/// lie on the edges, otherwise from an end of one of them to the other one.
[[nodiscard]] inline double edge_distance2(const Vec3d& a0, const Vec3d& a1, const Vec3d& b0,
                                           const Vec3d& b1) noexcept {
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
  const ClosestOnLines c = closest_on_lines(a0, a1, b0, b1);
  const bool on_both = c.sine2 > 0.0 && c.first >= 0.0 && c.first <= 1.0 && c.second >= 0.0 && c.second <= 1.0;
  return on_both && c.gap * c.gap < least ? c.gap * c.gap : least;
}

}  // namespace fexp::physics
