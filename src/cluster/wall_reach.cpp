// SPDX-License-Identifier: Apache-2.0
#include "cluster/wall_reach.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::cluster {

namespace {

/// Boxes that touch but for rounding count as touching.
constexpr double rounding = 1.0e-12;

/// Length of what of a unit vector along an axis is across a direction.
double across(double component) noexcept { return std::sqrt(std::max(0.0, 1.0 - component * component)); }

}  // namespace

bool may_reach(const model::Wall& wall, const Box& points, const Box& body) noexcept {
  // Seen from the wall's point, the body is somewhere in a box with this centre and these half edges.
  const Vec3d middle = 0.5 * ((body.low - points.high) + (body.high - points.low));
  const Vec3d half = 0.5 * ((body.high - points.low) - (body.low - points.high));
  const Vec3d& d = wall.direction;
  const double slack = rounding * (norm(middle) + norm(half) + norm(body.high) + norm(points.high));
  if (wall.shape == model::WallShape::plane) {
    const double spread = half.x * std::abs(d.x) + half.y * std::abs(d.y) + half.z * std::abs(d.z);
    return dot(middle, d) - spread <= slack;
  }
  double distance = norm(middle), spread = norm(half);
  if (wall.shape == model::WallShape::cylinder) {
    distance = norm(middle - dot(middle, d) * d);
    spread = std::min(spread, half.x * across(d.x) + half.y * across(d.y) + half.z * across(d.z));
  }
  return wall.inside ? distance + spread >= wall.radius - slack : distance - spread <= wall.radius + slack;
}

}  // namespace fexp::cluster
