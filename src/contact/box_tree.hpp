// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

namespace fexp::contact {

/// Balanced tree over boxes, which are halved along the longest extent of their centres again and again. Building runs
/// in parallel; queries may run side by side without locks.
class BoxTree {
 public:
  /// Replaces the boxes; empty ones are never found. Memory of earlier builds is used again.
  void build(std::span<const Box> boxes);

  /// Calls visit(i) for every box i of the build that overlaps `box`, touching included, in no particular order.
  template <class Visit>
  void query(const Box& box, const Visit& visit) const {
    const auto end = static_cast<Index>(subtrees_.size());
    for (Index i = 0; i < end;) {
      const Subtree& subtree = subtrees_[at(i)];
      if (!subtree.box.overlaps(box)) {
        i = subtree.behind;
        continue;
      }
      if (subtree.leaf != no_index) {
        visit(subtree.leaf);
      }
      ++i;
    }
  }

 private:
  /// A subtree is followed by its lower half, and that by the upper one.
  struct Subtree {
    Box box;
    Index behind;  // The first that is not part of this
    Index leaf;    // The box, or no_index where there are halves
  };
  struct Centre {
    Vec3d point;  // Twice the centre, which is as good
    Index box;
  };

  void build_subtree(Index subtree, IndexRange range, std::span<const Box> boxes);

  std::vector<Centre> centres_;  // [boxes that are not empty]
  std::vector<Subtree> subtrees_;
};

}  // namespace fexp::contact
