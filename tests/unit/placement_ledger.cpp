// SPDX-License-Identifier: Apache-2.0
#include "cluster/placement_ledger.hpp"

#include <gtest/gtest.h>

#include "support/hand_model.hpp"

namespace fexp::cluster {
namespace {

/// Bodies of 4, 4 and 4 elements and 6 nodes each.
class Ledger : public testing::Test {
 protected:
  void note(std::int64_t step, const Placement& placement, const std::string& reason) {
    ledger.note(model, step, 0.5 * static_cast<double>(step), placement, machines, reason);
  }

  model::Model model = test::strips(3, 2);
  std::vector<Machine> machines{{"a", 0, 1, 1.0, 1}, {"b", 1, 1, 1.0, 1}};
  PlacementLedger ledger;
};

TEST_F(Ledger, counts_what_every_machine_holds_and_what_has_moved_since_the_start) {
  note(0, {{0, 1, no_machine}, {{0, no_machine, 0, MoveReason::start}, {1, no_machine, 1, MoveReason::start}}},
       "start");
  note(7, {{0, 0, no_machine}, {{1, 1, 0, MoveReason::merge}}}, "1 island moved");
  ASSERT_EQ(ledger.frames().size(), 2U);
  EXPECT_EQ(ledger.frames()[0].elements, (std::vector<Index>{4, 4}));
  EXPECT_EQ(ledger.frames()[0].moved_elements, 0);
  EXPECT_EQ(ledger.frames()[1].step, 7);
  EXPECT_EQ(ledger.frames()[1].time, 3.5);
  EXPECT_EQ(ledger.frames()[1].elements, (std::vector<Index>{8, 0}));
  EXPECT_EQ(ledger.frames()[1].nodes, (std::vector<Index>{12, 0}));
  EXPECT_EQ(ledger.frames()[1].moved_elements, 4);
  EXPECT_EQ(ledger.frames()[1].moved_nodes, 6);
}

TEST_F(Ledger, of_two_placements_of_one_step_keeps_the_later_with_the_reason_of_the_first) {
  note(3, {{0, 1, 0}, {}}, "first");
  note(3, {{0, 0, 0}, {{1, 1, 0, MoveReason::merge}}}, "second");
  ASSERT_EQ(ledger.frames().size(), 1U);
  EXPECT_EQ(ledger.frames()[0].reason, "first");
  EXPECT_EQ(ledger.frames()[0].elements, (std::vector<Index>{12, 0}));
}

TEST_F(Ledger, gives_each_move_once) {
  note(0, {{0, 1, 1}, {{0, no_machine, 0, MoveReason::start}}}, "start");
  note(2, {{1, 1, 1}, {{0, 0, 1, MoveReason::balance}}}, "balance");
  const std::vector<LedgerMove> moves = ledger.take_moves();
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_EQ(moves[0].step, 2);
  EXPECT_EQ(moves[0].move.body, 0);
  EXPECT_STREQ(text_of(moves[0].move.reason), "balance");
  EXPECT_TRUE(ledger.take_moves().empty());
}

TEST_F(Ledger, of_very_many_changes_keeps_the_first_and_the_last) {
  const auto changes = static_cast<std::int64_t>(2 * frames_kept) + 7;
  for (std::int64_t step = 0; step < changes; ++step) {
    note(step, {{static_cast<MachineIndex>(step % 2), 1, 1}, {}}, "again");
  }
  ASSERT_EQ(ledger.frames().size(), 2 * frames_kept);
  EXPECT_EQ(ledger.frames_left_out(), 7);
  EXPECT_EQ(ledger.frames()[frames_kept - 1].step, static_cast<std::int64_t>(frames_kept) - 1);
  EXPECT_EQ(ledger.frames()[frames_kept].step, static_cast<std::int64_t>(frames_kept) + 7);
  EXPECT_EQ(ledger.frames().back().step, changes - 1);
}

TEST_F(Ledger, comes_back_from_its_bytes_and_what_is_cut_off_is_told) {
  note(0, {{0, 1, 1}, {}}, "start");
  note(2, {{1, 1, 1}, {{0, 0, 1, MoveReason::balance}}}, "a reason");
  ledger.add_bytes(1234);
  ByteWriter out;
  ledger.pack(out);
  const Bytes bytes = out.take();
  ByteReader in(bytes);
  const PlacementLedger copy = PlacementLedger::unpack(in);
  EXPECT_TRUE(in.sound());
  ASSERT_EQ(copy.frames().size(), 2U);
  EXPECT_EQ(copy.frames()[1].reason, "a reason");
  EXPECT_EQ(copy.frames()[1].nodes, ledger.frames()[1].nodes);
  EXPECT_EQ(copy.moved_elements(), 4);
  EXPECT_EQ(copy.moved_nodes(), 6);
  EXPECT_EQ(copy.moved_bytes(), 1234);
  ByteReader cut(std::span<const std::byte>(bytes.data(), bytes.size() - 1));
  static_cast<void>(PlacementLedger::unpack(cut));
  EXPECT_FALSE(cut.sound());
}

}  // namespace
}  // namespace fexp::cluster
