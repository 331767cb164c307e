// SPDX-License-Identifier: Apache-2.0
#include "contact/box_tree.hpp"

#include <algorithm>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

/// Subtrees larger than this are built side by side.
constexpr Index serial_boxes = 2048;
/// A tree is built anew when its boxes have grown by this factor.
constexpr double most_growth = 1.3;

bool is_empty(const Box& box) noexcept { return !(box.low.x <= box.high.x); }

/// Half of it [length^2].
double surface_of(const Box& box) noexcept {
  const Vec3d extent = box.high - box.low;
  return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

}  // namespace

void BoxTree::build(std::span<const Box> boxes) {
  centres_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_empty(boxes[i])) {
      centres_.push_back({boxes[i].low + boxes[i].high, static_cast<Index>(i)});
    }
  }
  subtrees_.resize(centres_.empty() ? 0 : 2 * centres_.size() - 1);
  if (!centres_.empty()) {
    build_subtree(0, {0, static_cast<Index>(centres_.size())}, boxes);
  }
  surface_ = 0.0;
  for (const Subtree& subtree : subtrees_) {
    surface_ += surface_of(subtree.box);
  }
}

void BoxTree::update(std::span<const Box> boxes) {
  if (!refit(boxes)) {
    build(boxes);
  }
}

/// Gives the subtrees the boxes of their halves. Whether the tree still is a good one of all boxes.
bool BoxTree::refit(std::span<const Box> boxes) {
  const auto none = std::ranges::count_if(boxes, is_empty);
  Index leaves = 0;
  double surface = 0.0;
  // Halves stand behind the whole.
  for (auto i = static_cast<Index>(subtrees_.size()) - 1; i >= 0; --i) {
    Subtree& subtree = subtrees_[at(i)];
    if (subtree.leaf == no_index) {
      subtree.box = subtrees_[at(lower_half(i))].box;
      subtree.box.include(subtrees_[at(upper_half(i))].box);
    } else if (at(subtree.leaf) < boxes.size()) {
      subtree.box = boxes[at(subtree.leaf)];
      leaves += is_empty(subtree.box) ? 0 : 1;
    } else {
      return false;
    }
    surface += is_empty(subtree.box) ? 0.0 : surface_of(subtree.box);
  }
  return leaves == static_cast<Index>(boxes.size()) - static_cast<Index>(none) && surface <= most_growth * surface_;
}

std::vector<BoxTree::Meeting> BoxTree::meetings(std::size_t least) const {
  std::vector<Meeting> present, parts;
  if (!subtrees_.empty()) {
    present.push_back({0, 0});
  }
  bool cut = true;
  while (cut && present.size() < least) {
    cut = false;
    parts.clear();
    for (const Meeting meeting : present) {
      const Subtree &first = subtrees_[at(meeting.first)], &second = subtrees_[at(meeting.second)];
      if (!first.box.overlaps(second.box)) {
        continue;
      }
      if (first.leaf != no_index && second.leaf != no_index) {
        parts.push_back(meeting);
        continue;
      }
      cut = true;
      for_each_part(meeting, [&](Meeting part) { parts.push_back(part); });
    }
    present.swap(parts);
  }
  return present;
}

void BoxTree::build_subtree(Index subtree, IndexRange range, std::span<const Box> boxes) {
  Subtree& made = subtrees_[at(subtree)];
  made.behind = subtree + 2 * range.size() - 1;
  if (range.size() == 1) {
    made.leaf = centres_[at(range.begin)].box;
    made.box = boxes[at(made.leaf)];
    return;
  }
  Box centres;
  for (Index i = range.begin; i < range.end; ++i) {
    centres.include(centres_[at(i)].point);
  }
  double Vec3d::*const axis = longest_axis(centres);
  const Index middle = range.begin + range.size() / 2;
  const auto begin = centres_.begin();
  std::nth_element(begin + range.begin, begin + middle, begin + range.end,
                   [axis](const Centre& a, const Centre& b) { return a.point.*axis < b.point.*axis; });
  const Index lower = subtree + 1, upper = subtree + 2 * (middle - range.begin);
  parallel::for_each(2, range.size() > serial_boxes ? 1 : 2, [&](Index half) {
    if (half == 0) {
      build_subtree(lower, {range.begin, middle}, boxes);
    } else {
      build_subtree(upper, {middle, range.end}, boxes);
    }
  });
  made.leaf = no_index;
  made.box = subtrees_[at(lower)].box;
  made.box.include(subtrees_[at(upper)].box);
}

}  // namespace fexp::contact
