// SPDX-License-Identifier: Apache-2.0
#include "contact/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "parallel/parallel.hpp"

namespace fexp::contact {
namespace {

std::vector<Index> slow_query(const std::vector<Box>& boxes, const Box& box) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].overlaps(box)) {
      found.push_back(static_cast<Index>(i));
    }
  }
  return found;
}

std::vector<Index> query(const BoxTree& tree, const Box& box) {
  std::vector<Index> found;
  tree.query(box, [&](Index i) { found.push_back(i); });
  std::ranges::sort(found);
  return found;
}

/// Boxes of many sizes, some empty, some points, many at the same place.
std::vector<Box> random_boxes(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Box> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 7 == 3) {
      continue;
    }
    boxes[i].include(i % 5 == 0 ? Vec3d{} : Vec3d{unit(random), unit(random), unit(random)});
    if (i % 3 != 0) {
      boxes[i] = boxes[i].grown(0.05 + 0.05 * unit(random));
    }
  }
  return boxes;
}

TEST(box_tree, finds_what_a_loop_over_all_boxes_finds) {
  std::mt19937 random(5);
  BoxTree tree;
  for (const std::size_t count : {1U, 2U, 3U, 8U, 100U, 1000U, 6000U, 4U}) {
    const std::vector<Box> boxes = random_boxes(count, random);
    for (const int threads : {1, 4}) {
      parallel::with_threads(threads, [&] { tree.build(boxes); });
      for (const Box& box : random_boxes(100, random)) {
        ASSERT_EQ(query(tree, box), slow_query(boxes, box)) << count;
      }
    }
  }
}

/// Pairs of boxes that overlap, and boxes with themselves, each as (smaller, larger).
using Pairs = std::vector<std::pair<Index, Index>>;

Pairs slow_pairs(const std::vector<Box>& boxes) {
  Pairs pairs;
  for (Index i = 0; i < static_cast<Index>(boxes.size()); ++i) {
    for (Index j = i; j < static_cast<Index>(boxes.size()); ++j) {
      if (boxes[at(i)].overlaps(boxes[at(j)])) {
        pairs.emplace_back(i, j);
      }
    }
  }
  return pairs;
}

Pairs pairs_of(const BoxTree& tree, std::size_t least) {
  Pairs pairs;
  for (const BoxTree::Meeting meeting : tree.meetings(least)) {
    tree.meet(meeting, [&](Index i, Index j) { pairs.emplace_back(std::min(i, j), std::max(i, j)); });
  }
  std::ranges::sort(pairs);
  return pairs;
}

TEST(box_tree, meets_itself_in_the_pairs_that_a_loop_over_all_finds) {
  std::mt19937 random(7);
  BoxTree tree;
  for (const std::size_t count : {1U, 2U, 3U, 8U, 100U, 1000U, 5U, 0U}) {
    const std::vector<Box> boxes = random_boxes(count, random);
    tree.build(boxes);
    for (const std::size_t least : {0U, 1U, 7U, 100'000U}) {
      ASSERT_EQ(pairs_of(tree, least), slow_pairs(boxes)) << count << ", " << least;
    }
  }
}

TEST(box_tree, updated_finds_what_a_loop_finds_wherever_boxes_have_moved) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  BoxTree tree;
  std::vector<Box> boxes = random_boxes(500, random);
  for (const double way : {0.0, 0.001, 0.01, 1.0, 0.001, 10.0, 0.0}) {
    for (Box& box : boxes) {
      const Vec3d shift{way * unit(random), way * unit(random), way * unit(random)};
      if (box.low.x <= box.high.x) {
        box = {box.low + shift, box.high + shift};
      }
    }
    // One that was empty is there, and one that was there is empty.
    const auto some = static_cast<std::size_t>(200.0 + 100.0 * unit(random));
    std::swap(boxes[some], boxes[some + 1]);
    tree.update(boxes);
    ASSERT_EQ(pairs_of(tree, 10), slow_pairs(boxes)) << way;
  }
  boxes.resize(20);
  tree.update(boxes);
  ASSERT_EQ(pairs_of(tree, 10), slow_pairs(boxes));
  boxes.resize(300, boxes[5]);
  tree.update(boxes);
  ASSERT_EQ(pairs_of(tree, 10), slow_pairs(boxes));
}

TEST(box_tree, counts_boxes_that_touch_and_none_that_nearly_do) {
  BoxTree tree;
  const std::vector<Box> boxes{{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}};
  tree.build(boxes);
  EXPECT_EQ(query(tree, {{1.0, 0.5, 0.5}, {2.0, 0.6, 0.6}}).size(), 1U);
  EXPECT_EQ(query(tree, {{std::nextafter(1.0, 2.0), 0.5, 0.5}, {2.0, 0.6, 0.6}}).size(), 0U);
}

TEST(box_tree, of_no_boxes_or_empty_ones_finds_nothing) {
  BoxTree tree;
  const Box everything{{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}};
  EXPECT_TRUE(query(tree, everything).empty());
  tree.build(std::vector<Box>(3));
  EXPECT_TRUE(query(tree, everything).empty());
  tree.build({});
  EXPECT_TRUE(query(tree, everything).empty());
}

}  // namespace
}  // namespace fexp::contact
