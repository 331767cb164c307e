// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

namespace fexp::contact {

/// Balanced kd-tree over points, each with a reach of its own. Every subtree halves the points of its parent along
/// their longest extent and keeps the bounding box of all that they reach, so a query descends only where boxes
/// overlap. Building runs in parallel; queries may run side by side without locks.
class KdTree {
 public:
  /// Replaces the points. `reach` [length] has shape [points], or is empty: then it is zero. Memory of earlier builds
  /// is used again.
  void build(std::span<const Vec3d> points, std::span<const double> reach = {});

  /// Calls visit(i) for every point i of the build that lies in the box when this is grown by the point's reach, bounds
  /// included, in no particular order.
  template <class Visit>
  void query(const Box& box, const Visit& visit) const {
    if (points_.empty()) {
      return;
    }
    std::array<Subtree, 64> open;
    std::size_t count = 0;
    open[count++] = {0, 0, static_cast<Index>(points_.size())};
    while (count > 0) {
      const Subtree t = open[--count];
      if (!boxes_[at(t.number)].overlaps(box)) {
        continue;
      }
      const Index left = 2 * t.number + 1;
      if (left >= static_cast<Index>(boxes_.size())) {
        for (Index i = t.begin; i < t.end; ++i) {
          if (box.grown(reach_[at(i)]).contains(points_[at(i)])) {
            visit(order_[at(i)]);
          }
        }
        continue;
      }
      const Index middle = t.begin + (t.end - t.begin) / 2;
      open[count++] = {left + 1, middle, t.end};
      open[count++] = {left, t.begin, middle};
    }
  }

 private:
  /// Points [begin, end) in tree order; children of number k are 2k + 1 and 2k + 2.
  struct Subtree {
    Index number;
    Index begin;
    Index end;
  };

  static constexpr Index leaf_points = 12;

  void split_level(Index level);

  std::vector<Box> boxes_;     // [subtrees], level by level
  std::vector<Index> order_;   // [points]: index given to build
  std::vector<Vec3d> points_;  // [points], in tree order
  std::vector<double> reach_;  // [points], in tree order
  std::span<const Vec3d> given_;
  std::span<const double> given_reach_;
};

}  // namespace fexp::contact
