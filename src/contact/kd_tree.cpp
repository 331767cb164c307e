// SPDX-License-Identifier: Apache-2.0
#include "contact/kd_tree.hpp"

#include <algorithm>
#include <limits>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index point_grain = 8192;
/// Subtrees larger than this are built side by side.
constexpr Index serial_points = 8192;

double component(const Vec3d& v, std::size_t axis) noexcept { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Box joined(Box a, const Box& b) noexcept {
  a.include(b);
  return a;
}

}  // namespace

void KdTree::build(std::span<const Vec3d> points, std::span<const double> reach) {
  const auto count = static_cast<Index>(points.size());
  const Box box = parallel::ordered_fold(
      {0, count}, point_grain, Box{},
      [&](Index begin, Index end) {
        Box part;
        for (Index i = begin; i < end; ++i) {
          part.include(points[at(i)]);
        }
        return part;
      },
      joined);
  const Vec3d extent = box.high - box.low;
  const double largest = std::max({extent.x, extent.y, extent.z});
  const double scale = largest > std::numeric_limits<double>::min() ? 1.0 / largest : 0.0;
  places_.resize(points.size());
  parallel::for_each(count, point_grain, [&](Index i) {
    const Vec3d x = scale * (points[at(i)] - box.low);
    places_[at(i)] = {{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)}, i};
  });
  std::size_t leaves = 1;
  while (points.size() > leaves * leaf_points) {
    leaves *= 2;
  }
  splits_.resize(leaves);
  leaves_.resize(leaves);
  bounds_ = build_subtree(1, {0, count}, points, reach);
}

/// Puts the points of a subtree in order. Returns the box of all that they reach.
Box KdTree::build_subtree(std::size_t subtree, IndexRange range, std::span<const Vec3d> points,
                          std::span<const double> reach) {
  if (subtree >= splits_.size()) {
    return build_leaf(subtree - splits_.size(), range, points, reach);
  }
  std::array<float, 3> low = places_[at(range.begin)].x, high = low;
  for (Index i = range.begin; i < range.end; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], places_[at(i)].x[d]);
      high[d] = std::max(high[d], places_[at(i)].x[d]);
    }
  }
  const std::array<float, 3> extent{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  const auto axis = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const Index middle = range.begin + range.size() / 2;
  const auto begin = places_.begin();
  std::nth_element(begin + range.begin, begin + middle, begin + range.end,
                   [axis](const Place& a, const Place& b) { return a.x[axis] < b.x[axis]; });
  Box below, above;
  parallel::for_each(2, range.size() > serial_points ? 1 : 2, [&](Index half) {
    if (half == 0) {
      below = build_subtree(2 * subtree, {range.begin, middle}, points, reach);
    } else {
      above = build_subtree(2 * subtree + 1, {middle, range.end}, points, reach);
    }
  });
  splits_[subtree] = {component(below.high, axis), component(above.low, axis), axis};
  return joined(below, above);
}

Box KdTree::build_leaf(std::size_t leaf, IndexRange range, std::span<const Vec3d> points,
                       std::span<const double> reach) {
  Box box;
  Leaf made;
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  made.x.fill(nowhere);
  made.y.fill(nowhere);
  made.z.fill(nowhere);
  made.reach.fill(0.0);
  made.point.fill(no_index);
  for (Index i = 0; i < range.size(); ++i) {
    const Index point = places_[at(range.begin + i)].point;
    const Vec3d& p = points[at(point)];
    const double far = reach.empty() ? 0.0 : reach[at(point)];
    made.x[at(i)] = p.x;
    made.y[at(i)] = p.y;
    made.z[at(i)] = p.z;
    made.reach[at(i)] = far;
    made.point[at(i)] = point;
    box.include(Box{p, p}.grown(far));
  }
  leaves_[leaf] = made;
  return box;
}

}  // namespace fexp::contact
