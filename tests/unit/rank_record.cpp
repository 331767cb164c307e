// SPDX-License-Identifier: Apache-2.0
#include "cluster/rank_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace fexp::cluster {
namespace {

RankRecord made(int k) {
  RankRecord record;
  record.good_steps = 10 - k;
  record.left_box = k == 1;
  record.contact_frequency2 = k == 0 ? 0.1 : 0.2;
  record.stiffest_node = 300 - k;
  record.stiffest_element = 400 - k;
  record.active_pairs = k;
  record.candidates = 2 * k;
  record.searches = 3 * k;
  record.deepest = k == 0 ? 0.25 : 0.5;
  record.deepest_node = 100 - k;
  record.deepest_element = 200 - k;
  record.broken_steps = 4;
  record.broken_node = k == 0 ? no_index : 50 - k;
  record.requests.snapshot = k == 2;
  record.messages = k;
  record.message_bytes = 1000 * k;
  record.moved_bytes = 7 * k;
  record.busy_seconds = 1.5 * k;
  record.waiting_seconds = 3.0 - k;
  return record;
}

TEST(rank_record, sums_are_the_same_in_any_order_of_ranks) {
  std::array<int, 3> order{0, 1, 2};
  RankRecord first;
  for (const int k : order) {
    first.add(made(k));
  }
  EXPECT_EQ(first.good_steps, 8);
  EXPECT_TRUE(first.left_box);
  EXPECT_EQ(first.contact_frequency2, 0.2);
  EXPECT_EQ(first.stiffest_node, 298);
  EXPECT_EQ(first.stiffest_element, 398);
  EXPECT_EQ(first.active_pairs, 3);
  EXPECT_EQ(first.candidates, 6);
  EXPECT_EQ(first.searches, 9);
  EXPECT_EQ(first.deepest, 0.5);
  EXPECT_EQ(first.deepest_node, 98);  // the lower of two as deep
  EXPECT_EQ(first.deepest_element, 198);
  EXPECT_EQ(first.broken_node, 48);
  EXPECT_TRUE(first.requests.snapshot);
  EXPECT_FALSE(first.requests.stop);
  EXPECT_EQ(first.message_bytes, 3000);
  EXPECT_EQ(first.moved_bytes, 21);
  EXPECT_EQ(first.busy_seconds, 3.0);
  EXPECT_EQ(first.waiting_seconds, 6.0);  // the sum
  while (std::next_permutation(order.begin(), order.end())) {
    RankRecord sum;
    for (const int k : order) {
      sum.add(made(k));
    }
    EXPECT_EQ(sum.deepest_node, first.deepest_node);
    EXPECT_EQ(sum.deepest_element, first.deepest_element);
    EXPECT_EQ(sum.broken_node, first.broken_node);
    EXPECT_EQ(sum.good_steps, first.good_steps);
    EXPECT_EQ(sum.contact_frequency2, first.contact_frequency2);
    EXPECT_EQ(sum.stiffest_node, first.stiffest_node);
  }
}

TEST(rank_record, the_earliest_failure_counts_whoever_has_it) {
  RankRecord late, early;
  late.broken_node = 3;
  late.broken_steps = 9;
  early.broken_node = 70;
  early.broken_steps = 2;
  RankRecord sum = late;
  sum.add(early);
  EXPECT_EQ(sum.broken_node, 70);
  EXPECT_EQ(sum.broken_steps, 2);
  sum.add(late);
  EXPECT_EQ(sum.broken_node, 70);
}

TEST(rank_record, an_island_that_left_its_box_or_broke_is_noted) {
  RankRecord record;
  solve::IslandReport island;
  island.steps_done = 5;
  record.add(island);
  EXPECT_EQ(record.good_steps, 5);
  EXPECT_FALSE(record.left_box);
  EXPECT_EQ(record.broken_node, no_index);
  island.stop = solve::StopReason::left_swept_box;
  island.steps_done = 3;
  record.add(island);
  EXPECT_TRUE(record.left_box);
  EXPECT_EQ(record.good_steps, 3);
  island.stop = solve::StopReason::not_finite;
  island.stop_node = 12;
  island.steps_done = 1;
  record.add(island);
  EXPECT_EQ(record.broken_node, 12);
  EXPECT_EQ(record.broken_steps, 1);
}

}  // namespace
}  // namespace fexp::cluster
