// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "physics/closest_lines.hpp"

namespace fexp::physics {

/// Most triangles at an edge.
inline constexpr std::size_t most_at_edge = 8;

/// Two edges a0 a1 and b0 b1, and the third corners of the triangles at each of them.
struct CrossingEdges {
  std::array<Vec3d, 4> end;                               ///< a0, a1, b0, b1
  std::array<std::array<Vec3d, most_at_edge>, 2> corner;  ///< Of the triangles at edge a, at edge b
  std::array<int, 2> triangles{};                         ///< 1 at a free edge, 2, or more where surfaces branch
};

/// How far two surfaces are closest where their edges cross, 0 to 1, and its gradient.
struct Sharpness {
  double part{1.0};
  std::array<Vec3d, 4> end{};  ///< By the ends [1/length]
  int corner{-1};              ///< By which corner it changes: most_at_edge x edge + triangle; -1: by none
  Vec3d by_corner;             ///< [1/length]
};

/// Squared sines between which a crossing fades as the edges come to be parallel.
inline constexpr double parallel_sine2 = 0.0025;
inline constexpr double crossing_sine2 = 0.01;
/// Sine of the angle between a triangle and the plane across the common normal over which a crossing fades, and that
/// below which a fold counts as flat.
inline constexpr double fading_sine = 0.3;
inline constexpr double flat_sine = 0.01;

namespace detail {

/// Lowers the sharpness to what a triangle at one of the edges leaves. With the unit normal n towards the other edge
/// and the direction m in the triangle's plane that leads away from its edge, what counts is -n.m: positive where the
/// triangle leads away from the other edge.
inline void lower_by_triangle(const CrossingEdges& edges, std::size_t edge, std::size_t triangle,
                              const ClosestOnLines& lines, int side, Sharpness& sharpness) noexcept {
  const Vec3d along_a = edges.end[1] - edges.end[0], along_b = edges.end[3] - edges.end[2];
  const Vec3d& along = edge == 0 ? along_a : along_b;
  const double length_n = norm(lines.normal), sign = edge == 0 ? side : -side;
  const Vec3d n = (sign / length_n) * lines.normal;
  const Vec3d from = edges.corner[edge][triangle] - edges.end[2 * edge];
  const double position = dot(from, along) / dot(along, along);
  const Vec3d inward = from - position * along;
  const double height = norm(inward);
  const Vec3d m = (1.0 / height) * inward;
  const double cosine = dot(n, m);
  const bool free = edges.triangles[edge] == 1;
  const double part = free ? 1.0 - cosine / fading_sine : (-cosine - flat_sine) / fading_sine;
  if (!(part < sharpness.part)) {
    return;
  }
  sharpness = {};
  sharpness.part = part > 0.0 ? part : 0.0;
  sharpness.corner = static_cast<int>(most_at_edge * edge + triangle);
  // -d(n.m) = -m.dn - n.dm, with dn across n and dm across m.
  const Vec3d turn = (sign / (length_n * fading_sine)) * (m - cosine * n);
  const Vec3d lean = (1.0 / (height * fading_sine)) * (n - cosine * m);
  std::array<Vec3d, 2> by_along{-cross(along_b, turn), -cross(turn, along_a)};
  by_along[edge] += position * lean;
  sharpness.end = {-by_along[0], by_along[0], -by_along[1], by_along[1]};
  sharpness.end[2 * edge] += lean;
  sharpness.by_corner = -lean;
}

}  // namespace detail

/// The surfaces are closest at the crossing, with the second edge on side +1 or -1 of the first one along the common
/// normal, where no triangle at an edge leads towards the other edge. At a fold it fades out before the triangle comes
/// to lie across the normal, at a free edge behind that, and where the edges come to be parallel.
[[nodiscard]] inline Sharpness sharpness_of(const CrossingEdges& edges, const ClosestOnLines& lines,
                                            int side) noexcept {
  Sharpness sharpness;
  const double part = (lines.sine2 - parallel_sine2) / (crossing_sine2 - parallel_sine2);
  if (part < 1.0) {
    const Vec3d a = edges.end[1] - edges.end[0], b = edges.end[3] - edges.end[2];
    const double a2 = dot(a, a), b2 = dot(b, b), scale = 2.0 / (crossing_sine2 - parallel_sine2);
    const Vec3d by_a = (scale / (a2 * b2)) * cross(b, lines.normal) - (scale * lines.sine2 / a2) * a;
    const Vec3d by_b = (scale / (a2 * b2)) * cross(lines.normal, a) - (scale * lines.sine2 / b2) * b;
    sharpness.part = part > 0.0 ? part : 0.0;
    sharpness.end = {-by_a, by_a, -by_b, by_b};
  }
  for (std::size_t edge = 0; edge < 2; ++edge) {
    for (std::size_t t = 0; t < static_cast<std::size_t>(edges.triangles[edge]); ++t) {
      detail::lower_by_triangle(edges, edge, t, lines, side, sharpness);
    }
  }
  return sharpness;
}

}  // namespace fexp::physics
