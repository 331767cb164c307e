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

  /// The same where boxes have moved since the last build: keeps the halves while boxes of subtrees have not grown
  /// much.
  void update(std::span<const Box> boxes);

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

  /// Two subtrees whose boxes may overlap each other, or one with itself.
  struct Meeting {
    Index first;
    Index second;
  };

  /// The pairs of the whole tree cut into meetings, at least as many as asked for where there are as many.
  [[nodiscard]] std::vector<Meeting> meetings(std::size_t least) const;

  /// Calls visit(i, j) for every pair of boxes of the meeting that overlap, touching included, and visit(i, i) for
  /// every box of a subtree that meets itself, in no particular order. Meetings may be held side by side.
  template <class Visit>
  void meet(Meeting meeting, const Visit& visit) const {
    const Subtree &first = subtrees_[at(meeting.first)], &second = subtrees_[at(meeting.second)];
    if (!first.box.overlaps(second.box)) {
      return;
    }
    if (first.leaf != no_index && second.leaf != no_index) {
      visit(first.leaf, second.leaf);
      return;
    }
    for_each_part(meeting, [&](Meeting part) { meet(part, visit); });
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

  [[nodiscard]] Index lower_half(Index subtree) const noexcept { return subtree + 1; }
  [[nodiscard]] Index upper_half(Index subtree) const noexcept { return subtrees_[at(subtree + 1)].behind; }

  /// Cuts a meeting of which one subtree at least has halves.
  template <class Visit>
  void for_each_part(Meeting meeting, const Visit& visit) const {
    const auto [first, second] = meeting;
    const Index lower = lower_half(first);
    if (first == second) {
      visit(Meeting{lower, lower});
      visit(Meeting{lower, upper_half(first)});
      visit(Meeting{upper_half(first), upper_half(first)});
    } else if (subtrees_[at(first)].behind - first >= subtrees_[at(second)].behind - second) {
      visit(Meeting{lower, second});
      visit(Meeting{upper_half(first), second});
    } else {
      visit(Meeting{first, lower_half(second)});
      visit(Meeting{first, upper_half(second)});
    }
  }

  [[nodiscard]] bool refit(std::span<const Box> boxes);
  void build_subtree(Index subtree, IndexRange range, std::span<const Box> boxes);

  std::vector<Centre> centres_;  // [boxes that are not empty]
  std::vector<Subtree> subtrees_;
  double surface_{};  // Of all subtrees' boxes when they were built [length^2]
};

}  // namespace fexp::contact
