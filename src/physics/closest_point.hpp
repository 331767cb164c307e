// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/vec3.hpp"

namespace fexp::physics {

/// Part of a triangle on which a closest point lies. Edge a runs from corner a to corner a + 1.
enum class Feature : std::uint8_t { face, edge_0, edge_1, edge_2, corner_0, corner_1, corner_2 };

[[nodiscard]] constexpr bool is_edge(Feature f) noexcept { return f >= Feature::edge_0 && f <= Feature::edge_2; }
[[nodiscard]] constexpr bool is_corner(Feature f) noexcept { return f >= Feature::corner_0; }
/// Number of the edge or corner, 0 to 2.
[[nodiscard]] constexpr std::size_t number_of(Feature f) noexcept {
  return (static_cast<std::size_t>(f) - (is_corner(f) ? 4U : 1U)) % 3U;
}

struct ClosestPoint {
  std::array<double, 3> weight;  ///< Shape functions of the corners there; they sum to 1.
  Vec3d offset;                  ///< From the closest point to the given one [length]
  double distance2;              ///< Its square [length^2]
  Feature feature;
};

/// Weights below this count as zero when the feature is named, so that triangles which share an edge or a corner name
/// the same one although each is rounded on its own. Its square is well above rounding: where one triangle names the
/// face, the distance to its neighbour's edge is larger by more than rounding.
inline constexpr double feature_tolerance = 1.0e-6;

[[nodiscard]] inline Feature feature_of(const std::array<double, 3>& weight) noexcept {
  const bool a = weight[0] > feature_tolerance, b = weight[1] > feature_tolerance, c = weight[2] > feature_tolerance;
  if (a && b && c) {
    return Feature::face;
  }
  if (a && b) {
    return Feature::edge_0;
  }
  if (b && c) {
    return Feature::edge_1;
  }
  if (c && a) {
    return Feature::edge_2;
  }
  return a ? Feature::corner_0 : b ? Feature::corner_1 : Feature::corner_2;
}

/// Point of triangle x1 x2 x3 that is closest to p, by the Voronoi regions of its corners, edges and face in turn.
[[nodiscard]] inline ClosestPoint closest_point(const Vec3d& p, const Vec3d& x1, const Vec3d& x2,
                                                const Vec3d& x3) noexcept {
  const Vec3d side_12 = x2 - x1, side_13 = x3 - x1, from_1 = p - x1, from_2 = p - x2, from_3 = p - x3;
  const double a1 = dot(side_12, from_1), b1 = dot(side_13, from_1);
  const double a2 = dot(side_12, from_2), b2 = dot(side_13, from_2);
  const double a3 = dot(side_12, from_3), b3 = dot(side_13, from_3);
  const double part_3 = a1 * b2 - a2 * b1;  // proportional to the area opposite to corner 3
  const double part_2 = a3 * b1 - a1 * b3;
  const double part_1 = a2 * b3 - a3 * b2;
  const auto between = [](double from, double to) { return from / (from - to); };

  double w2 = 0.0, w3 = 0.0;
  if (a1 <= 0.0 && b1 <= 0.0) {
    // corner 1
  } else if (a2 >= 0.0 && b2 <= a2) {
    w2 = 1.0;
  } else if (part_3 <= 0.0 && a1 >= 0.0 && a2 <= 0.0) {
    w2 = between(a1, a2);
  } else if (b3 >= 0.0 && a3 <= b3) {
    w3 = 1.0;
  } else if (part_2 <= 0.0 && b1 >= 0.0 && b3 <= 0.0) {
    w3 = between(b1, b3);
  } else if (part_1 <= 0.0 && b2 >= a2 && a3 >= b3) {
    w3 = between(b2 - a2, b3 - a3);
    w2 = 1.0 - w3;
  } else {
    const double inverse = 1.0 / (part_1 + part_2 + part_3);
    w2 = part_2 * inverse;
    w3 = part_3 * inverse;
  }
  ClosestPoint result;
  result.weight = {(1.0 - w2) - w3, w2, w3};
  result.offset = from_1 - (w2 * side_12 + w3 * side_13);
  result.distance2 = dot(result.offset, result.offset);
  result.feature = feature_of(result.weight);
  return result;
}

}  // namespace fexp::physics
