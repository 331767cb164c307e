// SPDX-License-Identifier: Apache-2.0
#include "cluster/overlapping_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

/// Boxes in one leaf at most.
constexpr Index leaf_boxes = 8;
/// Boxes that ask the tree in one piece of parallel work.
constexpr Index piece_boxes = 4096;
/// Ranges larger than this are split side by side.
constexpr Index serial_range = 16384;

/// Twice the centre of a box, as a key to sort by. That of an empty or infinite box is no number, and any place will do
/// for it.
Vec3d key_of(const Box& box) noexcept {
  const Vec3d sum = box.low + box.high;
  const auto number = [](double value) { return std::isnan(value) ? 0.0 : value; };
  return {number(sum.x), number(sum.y), number(sum.z)};
}

double along(const Vec3d& key, int axis) noexcept { return axis == 0 ? key.x : axis == 1 ? key.y : key.z; }

/// A binary tree of boxes. A node is a range of the order; its halves are its children.
class Tree {
 public:
  explicit Tree(std::span<const Box> boxes) : entries_(boxes.size()) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      entries_[i] = {boxes[i], key_of(boxes[i]), static_cast<Index>(i)};
    }
    std::size_t leaves = 1;
    while (boxes.size() > leaves * at(leaf_boxes)) {
      leaves *= 2;
    }
    bounds_.resize(2 * leaves);
    if (!entries_.empty()) {
      build(1, {0, size()});
    }
  }

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(entries_.size()); }

  /// Appends the pairs of the box at `position` of the order with those that come after it.
  void append_pairs(Index position, Pairs& pairs) const {
    struct Visit {
      std::size_t node;
      IndexRange range;
    };
    std::array<Visit, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = {1, {0, size()}};
    const Entry& own = entries_[at(position)];
    while (depth > 0) {
      const auto [node, range] = stack[--depth];
      if (range.end <= position + 1 || !bounds_[node].overlaps(own.box)) {
        continue;
      }
      if (2 * node >= bounds_.size()) {
        for (Index i = std::max(range.begin, position + 1); i < range.end; ++i) {
          const Entry& other = entries_[at(i)];
          if (own.box.overlaps(other.box)) {
            pairs.emplace_back(std::min(own.index, other.index), std::max(own.index, other.index));
          }
        }
      } else {
        const Index middle = middle_of(range);
        stack[depth++] = {2 * node + 1, {middle, range.end}};
        stack[depth++] = {2 * node, {range.begin, middle}};
      }
    }
  }

 private:
  struct Entry {
    Box box;
    Vec3d key;
    Index index{};
  };

  static Index middle_of(const IndexRange& range) noexcept { return range.begin + range.size() / 2; }

  /// Sorts a range into halves along the axis on which its keys spread most, and these again.
  void build(std::size_t node, IndexRange range) {
    Box keys;
    for (Index i = range.begin; i < range.end; ++i) {
      bounds_[node].include(entries_[at(i)].box);
      keys.include(entries_[at(i)].key);
    }
    if (2 * node >= bounds_.size()) {
      return;
    }
    const Vec3d spread = keys.high - keys.low;
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const Index middle = middle_of(range);
    std::nth_element(entries_.begin() + range.begin, entries_.begin() + middle, entries_.begin() + range.end,
                     [axis](const Entry& a, const Entry& b) {
                       const double x = along(a.key, axis), y = along(b.key, axis);
                       return x != y ? x < y : a.index < b.index;
                     });
    const Index grain = range.size() > serial_range ? 1 : 2;
    parallel::for_each(2, grain, [&](Index half) {
      build(2 * node + at(half), half == 0 ? IndexRange{range.begin, middle} : IndexRange{middle, range.end});
    });
  }

  std::vector<Entry> entries_;  // In the order of the leaves
  std::vector<Box> bounds_;     // [2 x leaves]: the root is 1, the children of i are 2 i and 2 i + 1
};

}  // namespace

Pairs overlapping_pairs(std::span<const Box> boxes) {
  const Tree tree(boxes);
  const Index count = tree.size();
  std::vector<Pairs> pieces(at((count + piece_boxes - 1) / piece_boxes));
  parallel::for_each(static_cast<Index>(pieces.size()), 1, [&](Index k) {
    const Index begin = k * piece_boxes;
    for (Index i = begin; i < std::min(begin + piece_boxes, count); ++i) {
      tree.append_pairs(i, pieces[at(k)]);
    }
  });
  std::size_t total = 0;
  for (const Pairs& piece : pieces) {
    total += piece.size();
  }
  Pairs pairs;
  pairs.reserve(total);
  for (const Pairs& piece : pieces) {
    pairs.insert(pairs.end(), piece.begin(), piece.end());
  }
  return pairs;
}

}  // namespace fexp::cluster
