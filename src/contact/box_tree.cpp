// SPDX-License-Identifier: Apache-2.0
#include "contact/box_tree.hpp"

#include <algorithm>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

/// Subtrees larger than this are built side by side.
constexpr Index serial_boxes = 2048;

}  // namespace

void BoxTree::build(std::span<const Box> boxes) {
  centres_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].low.x <= boxes[i].high.x) {
      centres_.push_back({boxes[i].low + boxes[i].high, static_cast<Index>(i)});
    }
  }
  subtrees_.resize(centres_.empty() ? 0 : 2 * centres_.size() - 1);
  if (!centres_.empty()) {
    build_subtree(0, {0, static_cast<Index>(centres_.size())}, boxes);
  }
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
