// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/pack.hpp"
#include "base/vec3.hpp"

namespace fexp::contact {

/// Balanced kd-tree over points, each with a reach of its own. Every subtree halves the points of its parent along
/// their longest extent and knows how far either half reaches along it, so a query descends only where it meets one.
/// Building runs in parallel; queries may run side by side without locks.
class KdTree {
 public:
  /// Replaces the points. `reach` [length] has shape [points], or is empty: then it is zero. Memory of earlier builds
  /// is used again.
  void build(std::span<const Vec3d> points, std::span<const double> reach = {});

  /// Calls visit(i) for every point i of the build that lies in the box when this is grown by the point's reach, bounds
  /// included, in no particular order.
  template <class Visit>
  void query(const Box& box, const Visit& visit) const {
    if (places_.empty() || !bounds_.overlaps(box)) {
      return;
    }
    const std::array<double, 3> low{box.low.x, box.low.y, box.low.z}, high{box.high.x, box.high.y, box.high.z};
    const std::size_t leaves = splits_.size();
    std::array<std::size_t, 32> open;
    std::size_t count = 0, subtree = 1;
    for (;;) {
      bool met = true;
      while (met && subtree < leaves) {
        const Split& split = splits_[subtree];
        const bool below = low[split.axis] <= split.below_high, above = high[split.axis] >= split.above_low;
        open[count] = 2 * subtree + 1;
        count += static_cast<std::size_t>(below && above);
        met = below || above;
        subtree = 2 * subtree + static_cast<std::size_t>(!below);
      }
      if (met) {
        const Leaf& leaf = leaves_[subtree - leaves];
        const std::array<std::int64_t, leaf_points> inside = leaf.inside(low, high);
        for (std::size_t i = 0; i < leaf_points; ++i) {
          if (inside[i] != 0) {
            visit(leaf.point[i]);
          }
        }
      }
      if (count == 0) {
        return;
      }
      subtree = open[--count];
    }
  }

 private:
  static constexpr std::size_t leaf_points = 8;

  /// Places that are not used have coordinates that are no numbers, so that nothing finds them.
  struct alignas(64) Leaf {
    std::array<double, leaf_points> x, y, z, reach;
    std::array<Index, leaf_points> point;  // As given to build

    /// Not zero for the points in the box. All of them are tested, without a branch.
    [[nodiscard]] std::array<std::int64_t, leaf_points> inside(const std::array<double, 3>& low,
                                                               const std::array<double, 3>& high) const noexcept {
      using Two = Pack<2>;
      std::array<std::int64_t, leaf_points> result;
      for (std::size_t i = 0; i < leaf_points; i += 2) {
        const Two far = Two::load(&reach[i]), px = Two::load(&x[i]), py = Two::load(&y[i]), pz = Two::load(&z[i]);
        const auto in_box = (px.v >= (low[0] - far).v) & (px.v <= (high[0] + far).v) & (py.v >= (low[1] - far).v) &
                            (py.v <= (high[1] + far).v) & (pz.v >= (low[2] - far).v) & (pz.v <= (high[2] + far).v);
        static_assert(sizeof(in_box) == 2 * sizeof(result[0]));
        std::memcpy(&result[i], &in_box, sizeof(in_box));
      }
      return result;
    }
  };
  /// How the points of a subtree are halved. Subtree k has the children 2 k and 2 k + 1; the root is 1, and numbers
  /// from that of the leaves on are leaves.
  struct Split {
    double below_high;  ///< Highest coordinate that the lower half reaches
    double above_low;   ///< Lowest one that the upper half reaches
    std::size_t axis;
  };
  /// A point as it is sorted: single precision is enough to halve by.
  struct Place {
    std::array<float, 3> x;  // From the lowest corner, in parts of the largest extent
    Index point;
  };

  Box build_subtree(std::size_t subtree, IndexRange range, std::span<const Vec3d> points,
                    std::span<const double> reach);
  Box build_leaf(std::size_t leaf, IndexRange range, std::span<const Vec3d> points, std::span<const double> reach);

  std::vector<Place> places_;  // [points], leaf by leaf
  std::vector<Split> splits_;  // [leaves]; the first is not used
  std::vector<Leaf> leaves_;   // [leaves]
  Box bounds_;                 // Of all that the points reach
};

}  // namespace fexp::contact
