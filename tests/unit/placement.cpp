// SPDX-License-Identifier: Apache-2.0
#include "cluster/placement.hpp"
#include "support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace fexp::cluster {
namespace {

using Lists = std::vector<std::vector<Index>>;
using test::machines_of;
using Owners = std::vector<MachineIndex>;

constexpr auto elements = PlacementRule::fewest_elements;
constexpr auto cost = PlacementRule::measured_cost;

std::vector<Island> islands_of(const Lists& lists) {
  std::vector<Island> islands;
  for (const auto& bodies : lists) {
    islands.push_back({bodies, {}});
  }
  return islands;
}

/// A run as far as placement sees it.
struct Course {
  std::vector<Machine> machines;
  std::vector<double> weight;
  Lists islands{};
  Owners owner = Owners(weight.size(), no_machine);
  PlacementRule rule{elements};
  std::vector<Move> moves{};

  /// Places the next islands; the moves must be the difference of the owners.
  const Owners& next(const Lists& lists) {
    const std::vector<Island> before = islands_of(islands), after = islands_of(lists);
    const Placement placement = place_islands({rule, after, before, owner, weight, machines});
    std::size_t k = 0;
    for (std::size_t b = 0; b < owner.size(); ++b) {
      if (placement.owner[b] != owner[b]) {
        EXPECT_LT(k, placement.moves.size());
        const Move move = k < placement.moves.size() ? placement.moves[k++] : Move{};
        EXPECT_EQ(at(move.body), b);
        EXPECT_EQ(move.from, owner[b]);
        EXPECT_EQ(move.to, placement.owner[b]);
      }
    }
    EXPECT_EQ(k, placement.moves.size());
    moves = placement.moves;
    owner = placement.owner;
    islands = lists;
    return owner;
  }

  /// Reasons of the last moves, by body.
  [[nodiscard]] std::map<Index, MoveReason> reasons() const {
    std::map<Index, MoveReason> found;
    for (const Move& move : moves) {
      found[move.body] = move.reason;
    }
    return found;
  }

  [[nodiscard]] double load(MachineIndex machine) const {
    double sum = 0.0;
    for (std::size_t b = 0; b < owner.size(); ++b) {
      sum += owner[b] == machine ? weight[b] : 0.0;
    }
    return sum;
  }
};

const Lists apart{{0}, {1}, {2}, {3}};

TEST(placement, four_spheres_on_three_machines_and_a_fourth_go_as_in_the_papers_table) {
  Course run{machines_of({1, 1, 1}), {192, 192, 192, 192}};
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 2, 0}));
  EXPECT_EQ(run.next({{0, 1}, {2}, {3}}), (Owners{0, 0, 2, 0}));
  run.machines = machines_of({1, 1, 1, 1});
  EXPECT_EQ(run.next({{0, 1}, {2, 3}}), (Owners{0, 0, 0, 0}));
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 2, 3}));
}

TEST(placement, four_spheres_on_four_machines_part_and_gather_in_pairs) {
  Course run{machines_of({1, 1, 1, 1}), {192, 192, 192, 192}};
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 2, 3}));
  EXPECT_EQ(run.next({{0, 1}, {2}, {3}}), (Owners{0, 0, 2, 3}));
  EXPECT_EQ(run.reasons(), (std::map<Index, MoveReason>{{1, MoveReason::merge}}));
  EXPECT_EQ(run.next({{0, 1}, {2, 3}}), (Owners{0, 0, 2, 2}));
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 2, 3}));
  EXPECT_EQ(run.reasons(), (std::map<Index, MoveReason>{{1, MoveReason::split}, {3, MoveReason::split}}));
}

TEST(placement, starts_with_the_largest_islands_and_the_lowest_of_equally_loaded_machines) {
  Course run{machines_of({1, 1, 1}), {10, 40, 20, 30, 20}};
  // 40 to machine 0, 30 to 1, 20 (body 2) to 2, 20 (body 4) to 2, 10 to 1.
  EXPECT_EQ(run.next({{0}, {1}, {2}, {3}, {4}}), (Owners{1, 0, 2, 1, 2}));
  EXPECT_EQ(run.reasons().at(4), MoveReason::start);
}

TEST(placement, an_island_is_one_piece_of_weight_and_stays_together) {
  Course run{machines_of({1, 1}), {10, 10, 10, 25}};
  EXPECT_EQ(run.next({{0, 1, 2}, {3}}), (Owners{0, 0, 0, 1}));
}

TEST(placement, a_merged_island_gathers_where_most_of_it_is) {
  Course run{machines_of({1, 1, 1}), {10, 20, 20}};
  run.owner = {0, 2, 1};
  run.islands = {{0}, {1}, {2}};
  EXPECT_EQ(run.next({{0, 1}, {2}}), (Owners{2, 2, 1}));
  EXPECT_EQ(run.next({{0, 1, 2}}), (Owners{2, 2, 2}));
}

TEST(placement, by_elements_the_lowest_of_machines_with_equal_parts_gathers_a_merged_island) {
  Course run{machines_of({1, 1, 1}), {10, 20, 20, 5}};
  run.owner = {0, 2, 1, 1};
  run.islands = apart;
  EXPECT_EQ(run.next({{0}, {1, 2}, {3}}), (Owners{0, 1, 1, 1}));
}

TEST(placement, by_cost_the_least_loaded_of_machines_with_equal_parts_gathers_a_merged_island_then_the_lowest) {
  Course run{machines_of({1, 1, 1}), {40, 20, 20, 5}};
  run.rule = cost;
  run.owner = {0, 2, 1, 2};
  run.islands = apart;
  // Both have 20 of the island; machine 2 has 5 besides.
  EXPECT_EQ(run.next({{0}, {1, 2}, {3}}), (Owners{0, 1, 1, 2}));
  run.owner = {0, 2, 1, 1};
  run.islands = apart;
  EXPECT_EQ(run.next({{0}, {1, 2}, {3}}), (Owners{0, 2, 2, 1}));
  run.owner = {0, 2, 1, 0};
  run.islands = apart;
  // A tie of idle machines; body 3 then balances.
  EXPECT_EQ(run.next({{0}, {1, 2}, {3}}), (Owners{0, 1, 1, 2}));
}

TEST(placement, by_cost_many_pairs_of_equal_bodies_that_merge_at_once_share_the_machines_evenly) {
  constexpr Index pairs = 100;
  Course run{machines_of({1, 1}), std::vector<double>(at(2 * pairs), 192.0)};
  run.rule = cost;
  Lists alone, together;
  for (Index p = 0; p < pairs; ++p) {
    alone.insert(alone.end(), {{2 * p}, {2 * p + 1}});
    together.push_back({2 * p, 2 * p + 1});
  }
  run.next(alone);
  run.next(together);
  EXPECT_EQ(run.load(0), run.load(1));
  run.next(alone);
  EXPECT_EQ(run.load(0), run.load(1));
}

TEST(placement, unchanged_islands_stay_however_uneven_the_load_is) {
  Course run{machines_of({1, 1, 1}), {10, 10, 10, 10}};
  run.owner = {1, 1, 1, 1};
  run.islands = apart;
  EXPECT_EQ(run.next(apart), (Owners{1, 1, 1, 1}));
  EXPECT_TRUE(run.moves.empty());
}

TEST(placement, a_machine_that_joined_idles_until_islands_change) {
  Course run{machines_of({1}), {10, 10, 10}};
  run.next({{0}, {1, 2}});
  run.machines = machines_of({1, 1});
  EXPECT_EQ(run.next({{0}, {1, 2}}), (Owners{0, 0, 0}));
  // The first piece stays, the second finds the idle machine.
  EXPECT_EQ(run.next({{0}, {1}, {2}}), (Owners{0, 0, 1}));
}

TEST(placement, islands_of_a_machine_that_left_go_to_the_least_loaded_of_the_rest) {
  Course run{machines_of({1, 1, 1}), {30, 20, 10, 5}};
  run.next(apart);
  ASSERT_EQ(run.owner, (Owners{0, 1, 2, 2}));
  run.machines[0].rank = -1;
  EXPECT_EQ(run.next(apart), (Owners{2, 1, 2, 2}));
  EXPECT_EQ(run.reasons(), (std::map<Index, MoveReason>{{0, MoveReason::machine_left}}));
}

TEST(placement, what_is_left_of_an_island_that_merges_while_a_machine_leaves_decides_where_it_gathers) {
  Course run{machines_of({1, 1, 1}), {30, 20, 10, 5}};
  run.next(apart);
  ASSERT_EQ(run.owner, (Owners{0, 1, 2, 2}));
  run.machines[0].rank = -1;
  // Most of the island was on machine 0, which is gone.
  EXPECT_EQ(run.next({{0, 2}, {1}, {3}}), (Owners{2, 1, 2, 2}));
  EXPECT_EQ(run.reasons(), (std::map<Index, MoveReason>{{0, MoveReason::machine_left}}));
}

TEST(placement, of_two_islands_that_split_on_one_machine_one_piece_stays_in_all) {
  Course run{machines_of({1, 1, 1, 1}), {10, 10, 10, 10}};
  run.owner = {1, 1, 1, 1};
  run.islands = {{0, 1}, {2, 3}};
  EXPECT_EQ(run.next(apart), (Owners{1, 0, 2, 3}));
}

TEST(placement, the_largest_piece_stays_and_others_leave_while_their_target_stays_below_the_load_they_leave) {
  Course run{machines_of({1, 1}), {10, 30, 10, 25}};
  run.owner = {0, 0, 0, 1};
  run.islands = {{0, 1, 2}, {3}};
  // Body 1 stays. Body 0 goes: 25 + 10 < 50. Body 2 does not: 35 + 10 > 40.
  EXPECT_EQ(run.next(apart), (Owners{1, 0, 0, 1}));
  // At equality a piece stays: 30 + 10 = 40.
  Course equal{machines_of({1, 1}), {10, 30, 30}};
  equal.owner = {0, 0, 1};
  equal.islands = {{0, 1}, {2}};
  EXPECT_EQ(equal.next({{0}, {1}, {2}}), (Owners{0, 0, 1}));
}

TEST(placement, a_part_that_merges_elsewhere_leaves_the_rest_of_its_island_as_a_piece) {
  Course run{machines_of({1, 1, 1}), {10, 20, 30}};
  run.owner = {0, 0, 1};
  run.islands = {{0, 1}, {2}};
  // Body 1 gathers with 2; body 0 is the only piece of machine 0 and stays.
  EXPECT_EQ(run.next({{0}, {1, 2}}), (Owners{0, 1, 1}));
  EXPECT_EQ(run.reasons(), (std::map<Index, MoveReason>{{1, MoveReason::merge}}));
}

TEST(placement, one_machine_gets_everything_and_nothing_moves_from_then_on) {
  for (const PlacementRule rule : {elements, cost}) {
    Course run{machines_of({2}), {10, 20, 30, 40}};
    run.rule = rule;
    EXPECT_EQ(run.next(apart), (Owners{0, 0, 0, 0}));
    run.next({{0, 1}, {2, 3}});
    EXPECT_TRUE(run.moves.empty());
    run.next(apart);
    EXPECT_TRUE(run.moves.empty());
  }
}

TEST(placement, barriers_have_no_machine) {
  Course run{machines_of({1, 1}), {10, 1000, 10}};
  EXPECT_EQ(run.next({{0}, {2}}), (Owners{0, no_machine, 1}));
}

TEST(placement, measured_cost_loads_machines_by_their_speed) {
  Course run{machines_of({1, 3}), {10, 10, 10, 10}};
  run.rule = cost;
  // Machine 0 gets the first as a tie; then 10/3 and 20/3 are less than 10; at 30/3 = 10 machine 0 is the lowest, but
  // machine 1 had 20/3 when the last one was placed.
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 1, 1}));
  run.rule = elements;
  run.islands.clear();
  run.owner.assign(4, no_machine);
  EXPECT_EQ(run.next(apart), (Owners{0, 1, 0, 1}));
}

TEST(placement, measured_cost_moves_unchanged_islands_when_that_makes_the_busiest_machine_less_busy) {
  Course run{machines_of({1, 1}), {4, 3, 2, 1}};
  run.rule = cost;
  run.owner = {0, 0, 0, 0};
  run.islands = apart;
  run.next(apart);
  EXPECT_EQ(run.load(0), 5.0);
  EXPECT_EQ(run.load(1), 5.0);
  for (const auto& [body, reason] : run.reasons()) {
    EXPECT_EQ(reason, MoveReason::balance) << body;
  }
}

TEST(placement, measured_cost_leaves_a_tenth_of_imbalance_and_one_island_that_is_too_large) {
  Course slight{machines_of({1, 1}), {5.4, 0.1, 4.5}};
  slight.rule = cost;
  slight.owner = {0, 0, 1};
  slight.islands = {{0}, {1}, {2}};
  slight.next(slight.islands);
  EXPECT_TRUE(slight.moves.empty());
  Course large{machines_of({1, 1}), {9, 1}};
  large.rule = cost;
  large.owner = {0, 1};
  large.islands = {{0}, {1}};
  large.next(large.islands);
  EXPECT_TRUE(large.moves.empty());
}

TEST(placement, measured_cost_spreads_many_small_islands_over_a_machine_that_joined_in_one_epoch) {
  constexpr Index count = 3000;
  Course run{machines_of({1, 1, 1}), std::vector<double>(at(count), 1.0)};
  run.rule = cost;
  for (Index b = 0; b < count; ++b) {
    run.islands.push_back({b});
    run.owner[at(b)] = b % 2;
  }
  const Lists same = run.islands;
  run.next(same);
  for (const MachineIndex machine : {0, 1, 2}) {
    EXPECT_LE(run.load(machine), 1.051 * count / 3.0) << machine;
  }
  // What is even enough stays.
  run.next(same);
  EXPECT_TRUE(run.moves.empty());
}

/// Random groups of bodies, of which some in `keep` are as before.
Lists random_islands(std::mt19937& random, std::size_t bodies, const Lists& before) {
  Lists lists;
  std::vector<Index> loose;
  std::vector<bool> kept(bodies, false);
  for (const auto& list : before) {
    if (random() % 2 == 0) {
      lists.push_back(list);
      for (const Index body : list) {
        kept[at(body)] = true;
      }
    }
  }
  for (std::size_t b = 0; b < bodies; ++b) {
    if (!kept[b]) {
      loose.push_back(static_cast<Index>(b));
    }
  }
  std::shuffle(loose.begin(), loose.end(), random);
  for (std::size_t i = 0; i < loose.size();) {
    const std::size_t size = std::min<std::size_t>(1 + random() % 4, loose.size() - i);
    auto& list = lists.emplace_back(loose.begin() + static_cast<std::ptrdiff_t>(i),
                                    loose.begin() + static_cast<std::ptrdiff_t>(i + size));
    std::sort(list.begin(), list.end());
    i += size;
  }
  std::sort(lists.begin(), lists.end());
  return lists;
}

TEST(placement, random_runs_keep_islands_together_on_present_machines_and_unchanged_ones_in_place) {
  std::mt19937 random(7);
  int stayed = 0, moved = 0;
  for (int round = 0; round < 300; ++round) {
    const std::size_t bodies = 1 + random() % 40;
    Course run{machines_of({1, 2, 1, 3, 1}), std::vector<double>(bodies)};
    run.rule = round % 2 == 0 ? elements : cost;
    for (double& weight : run.weight) {
      weight = 1.0 + static_cast<double>(random() % 50);
    }
    for (int epoch = 0; epoch < 8; ++epoch) {
      for (std::size_t m = 1; m < run.machines.size(); ++m) {
        run.machines[m].rank = random() % 4 == 0 ? -1 : static_cast<int>(m);
      }
      const Lists before = run.islands, after = random_islands(random, bodies, before);
      const Owners owner_before = run.owner;
      Course again = run;
      run.next(after);
      EXPECT_EQ(again.next(after), run.owner);
      for (const auto& list : after) {
        const MachineIndex machine = run.owner[at(list.front())];
        ASSERT_NE(machine, no_machine);
        EXPECT_TRUE(run.machines[static_cast<std::size_t>(machine)].present());
        for (const Index body : list) {
          EXPECT_EQ(run.owner[at(body)], machine);
        }
        const MachineIndex was = owner_before[at(list.front())];
        const bool unchanged = std::ranges::find(before, list) != before.end();
        if (run.rule == elements && unchanged && run.machines[static_cast<std::size_t>(was)].present()) {
          EXPECT_EQ(machine, was);
          ++stayed;
        }
      }
      moved += static_cast<int>(run.moves.size());
    }
  }
  EXPECT_GT(stayed, 1000);
  EXPECT_GT(moved, 1000);
}

}  // namespace
}  // namespace fexp::cluster
