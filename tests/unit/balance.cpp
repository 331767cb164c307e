// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "cluster/placement.hpp"
#include "support/machines.hpp"

namespace fexp::cluster {
namespace {

using test::machines_of;
using Owners = std::vector<MachineIndex>;

TEST(balance, an_island_of_five_sixths_of_the_work_keeps_two_machines_busy_at_most) {
  const BalanceReport report = judge_balance(std::vector{0.83, 0.10, 0.07}, Owners{0, 0, 0}, machines_of({1}));
  EXPECT_DOUBLE_EQ(report.largest_share, 0.83);
  EXPECT_NEAR(report.imbalance, 0.0, 1.0e-15);
  EXPECT_DOUBLE_EQ(report.with_one_more, 0.83);
  EXPECT_EQ(report.useful_machines, 2);
}

TEST(balance, one_island_keeps_one_machine_busy) {
  const BalanceReport report = judge_balance(std::vector{2.0, 0.001}, Owners{0, 0}, machines_of({1}));
  EXPECT_EQ(report.useful_machines, 1);
  EXPECT_NEAR(report.with_one_more, 1.0, 1.0e-3);
}

TEST(balance, of_four_islands_on_two_machines_is_what_a_hand_computes) {
  const BalanceReport report = judge_balance(std::vector{4.0, 3.0, 2.0, 1.0}, Owners{0, 0, 1, 1}, machines_of({1, 1}));
  EXPECT_DOUBLE_EQ(report.largest_share, 0.4);
  EXPECT_DOUBLE_EQ(report.imbalance, 0.4);            // 7 over a mean of 5
  EXPECT_DOUBLE_EQ(report.with_one_more, 4.0 / 7.0);  // 4, 3, 2 + 1
  EXPECT_EQ(report.useful_machines, 3);
}

TEST(balance, machines_are_useful_as_long_as_islands_share_one_for_longer_than_the_largest_takes) {
  // Two of 0.18 take longer than 0.28, so each island wants a machine.
  const BalanceReport report =
      judge_balance(std::vector{0.28, 0.18, 0.18, 0.18, 0.18}, Owners{0, 0, 0, 0, 0}, machines_of({1}));
  EXPECT_EQ(report.useful_machines, 5);
  const std::vector<double> equal(100, 1.0);
  EXPECT_EQ(judge_balance(equal, Owners(100, 0), machines_of({1})).useful_machines, 100);
}

TEST(balance, speeds_count_and_machines_that_left_do_not) {
  std::vector<Machine> machines = machines_of({1, 3, 1});
  machines[2].rank = -1;
  const BalanceReport even = judge_balance(std::vector{1.0, 3.0}, Owners{0, 1}, machines);
  EXPECT_NEAR(even.imbalance, 0.0, 1.0e-15);
  const BalanceReport uneven = judge_balance(std::vector{2.0, 2.0}, Owners{0, 1}, machines);
  EXPECT_NEAR(uneven.imbalance, 1.0, 1.0e-15);  // 2 over 4 / 4
}

TEST(balance, nothing_measured_gives_the_report_of_one_machine) {
  const BalanceReport report = judge_balance(std::vector{0.0, 0.0}, Owners{0, 0}, machines_of({1, 1}));
  EXPECT_EQ(report.largest_share, 0.0);
  EXPECT_EQ(report.useful_machines, 1);
}

}  // namespace
}  // namespace fexp::cluster
