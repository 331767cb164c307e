// SPDX-License-Identifier: Apache-2.0
#include "contact/kd_tree.hpp"

#include <algorithm>
#include <numeric>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index copy_grain = 4096;

double component(const Vec3d& v, int axis) noexcept { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int longest_axis(const Box& box) noexcept {
  const Vec3d extent = box.high - box.low;
  if (extent.x >= extent.y && extent.x >= extent.z) {
    return 0;
  }
  return extent.y >= extent.z ? 1 : 2;
}

/// Points of subtree `place` of a level: the range that halving [0, count) level by level gives.
IndexRange range_of(Index level, Index place, Index count) noexcept {
  IndexRange range{0, count};
  for (Index bit = level - 1; bit >= 0; --bit) {
    const Index middle = range.begin + range.size() / 2;
    if ((place >> bit & 1) != 0) {
      range.begin = middle;
    } else {
      range.end = middle;
    }
  }
  return range;
}

}  // namespace

void KdTree::build(std::span<const Vec3d> points, std::span<const double> reach) {
  const auto count = static_cast<Index>(points.size());
  given_ = points;
  given_reach_ = reach;
  order_.resize(points.size());
  points_.resize(points.size());
  reach_.assign(points.size(), 0.0);
  std::iota(order_.begin(), order_.end(), 0);
  Index levels = 0;
  while ((count >> levels) > leaf_points) {
    ++levels;
  }
  boxes_.resize((std::size_t{2} << levels) - 1);
  for (Index level = 0; level <= levels; ++level) {
    split_level(level);
  }
  parallel::for_each(count, copy_grain, [&](Index i) {
    points_[at(i)] = points[at(order_[at(i)])];
    reach_[at(i)] = reach.empty() ? 0.0 : reach[at(order_[at(i)])];
  });
  given_ = {};
  given_reach_ = {};
}

/// Boxes of a level's subtrees, and their points halved for the next level.
void KdTree::split_level(Index level) {
  const Index subtrees = Index{1} << level;
  const bool last = at(2 * subtrees - 1) == boxes_.size();
  parallel::for_each(
      subtrees, std::max(Index{1}, copy_grain * subtrees / std::max(static_cast<Index>(order_.size()), 1)),
      [&](Index place) {
        const IndexRange range = range_of(level, place, static_cast<Index>(order_.size()));
        Box box;
        for (Index i = range.begin; i < range.end; ++i) {
          const Index point = order_[at(i)];
          box.include(
              Box{given_[at(point)], given_[at(point)]}.grown(given_reach_.empty() ? 0.0 : given_reach_[at(point)]));
        }
        boxes_[at(subtrees - 1 + place)] = box;
        if (!last) {
          const int axis = longest_axis(box);
          const auto begin = order_.begin();
          std::nth_element(
              begin + range.begin, begin + range.begin + range.size() / 2, begin + range.end,
              [&](Index a, Index b) { return component(given_[at(a)], axis) < component(given_[at(b)], axis); });
        }
      });
}

}  // namespace fexp::contact
