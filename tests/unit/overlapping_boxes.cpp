// SPDX-License-Identifier: Apache-2.0
#include "cluster/overlapping_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "parallel/parallel.hpp"

namespace fexp::cluster {
namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

/// The definition: every box against every other.
Pairs pairs_by_definition(const std::vector<Box>& boxes) {
  Pairs pairs;
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (boxes[a].overlaps(boxes[b])) {
        pairs.emplace_back(static_cast<Index>(a), static_cast<Index>(b));
      }
    }
  }
  return pairs;
}

Pairs sorted_pairs(const std::vector<Box>& boxes) {
  Pairs pairs = overlapping_pairs(boxes);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(overlapping_boxes, are_those_of_the_definition_whatever_their_number_and_sizes) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::size_t found = 0;
  for (const std::size_t count : {0U, 1U, 2U, 7U, 8U, 9U, 16U, 17U, 100U, 1000U, 5000U}) {
    for (int round = 0; round < 6; ++round) {
      // Equal sizes, sizes over six decades, in space, in a plane and on a line.
      const bool alike = round % 2 == 0;
      const double y = round / 2 < 2 ? 1.0 : 0.0, z = round / 2 < 1 ? 1.0 : 0.0;
      std::vector<Box> boxes;
      for (std::size_t i = 0; i < count; ++i) {
        const Vec3d centre{place(random), y * place(random), z * place(random)};
        const double half =
            alike ? 0.3 / std::cbrt(1.0 + static_cast<double>(count)) : 0.2 * std::pow(10.0, -6.0 * place(random));
        boxes.push_back(Box{centre, centre}.grown(half));
      }
      const Pairs pairs = sorted_pairs(boxes);
      ASSERT_EQ(pairs, pairs_by_definition(boxes)) << count << " boxes, round " << round;
      found += pairs.size();
    }
  }
  EXPECT_GT(found, 10'000U);
}

TEST(overlapping_boxes, may_be_equal_empty_infinite_or_share_a_face) {
  std::vector<Box> boxes(40, Box{{0, 0, 0}, {1, 1, 1}});
  boxes.push_back({});                                                                   // empty
  boxes.push_back({{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}});  // everything
  boxes.push_back({{1, 0, 0}, {2, 1, 1}});                                               // a common face
  boxes.push_back({{std::nextafter(1.0, 2.0), 0, 0}, {2, 1, 1}});                        // none
  boxes.push_back({{1.0e300, 0, 0}, {1.0e300, 1, 1}});
  EXPECT_EQ(sorted_pairs(boxes), pairs_by_definition(boxes));
}

TEST(overlapping_boxes, come_in_the_same_order_for_any_number_of_threads) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.0, 30.0);
  std::vector<Box> boxes;
  for (int i = 0; i < 40'000; ++i) {
    const Vec3d centre{place(random), place(random), place(random)};
    boxes.push_back(Box{centre, centre}.grown(0.6));
  }
  Pairs one, several;
  parallel::with_threads(1, [&] { one = overlapping_pairs(boxes); });
  parallel::with_threads(4, [&] { several = overlapping_pairs(boxes); });
  EXPECT_GT(one.size(), 40'000U);
  EXPECT_EQ(one, several);
}

}  // namespace
}  // namespace fexp::cluster
