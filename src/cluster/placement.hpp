// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cluster/interaction_graph.hpp"

namespace fexp::cluster {

/// Index of a machine in the run's list, in the order in which machines joined.
using MachineIndex = int;
inline constexpr MachineIndex no_machine = -1;

/// One that takes part in the run (the paper's computing workstation), or that did.
struct Machine {
  std::string name;
  int rank{-1};           ///< In the present world; negative: left or lost
  int threads{1};         ///< That compute
  double speed{1.0};      ///< Relative to the others'
  int native_threads{1};  ///< Hardware threads of the machine

  [[nodiscard]] bool present() const noexcept { return rank >= 0; }
};

/// fewest_elements: the paper's rule. Islands go to the machine with the fewest elements, and are looked at again only
/// when they merge, split, or their machine leaves. measured_cost: the same with the measured cost of each island
/// instead of its elements and loads divided by speeds; besides, when the busiest machine is a tenth above the mean,
/// islands move from the busiest to the least busy ones.
enum class PlacementRule : std::uint8_t { fewest_elements, measured_cost };

enum class MoveReason : std::uint8_t { start, merge, split, machine_left, balance };

/// One body's change of machine.
struct Move {
  Index body{};
  MachineIndex from{no_machine};
  MachineIndex to{no_machine};
  MoveReason reason{};
};

struct PlacementTask {
  PlacementRule rule{PlacementRule::fewest_elements};
  /// The islands to place, by their lowest bodies, and those of the placement before (empty at the start).
  std::span<const Island> islands;
  std::span<const Island> before;
  /// Machine of each body so far; no_machine at the start and for barriers, which belong to every machine.
  std::span<const MachineIndex> owner;  // [bodies]
  /// Elements, or measured cost [time].
  std::span<const double> weight;  // [bodies]
  std::span<const Machine> machines;
};

struct Placement {
  std::vector<MachineIndex> owner;  // [bodies]
  std::vector<Move> moves;          ///< By body
};

/// Places every island on one present machine, of which there must be one. A pure function. The rule [REK19, section 5,
/// tables 1 and 2; the text of the rule is not in the paper, this one gives its tables]:
/// 1. An island that was there before stays, unless its machine has left.
/// 2. A merged island gathers on the machine that holds most of its elements; ties go to the lowest machine (by cost to
///    the least loaded one).
/// 3. Of the pieces that islands on one machine have split into, the first (most elements, then lowest body) stays.
///    Each other goes to the least loaded machine if that stays less loaded than the one it leaves was.
/// 4. Islands without a machine, most elements first, go to the least loaded one; ties go to the lowest.
[[nodiscard]] Placement place_islands(const PlacementTask& task);

/// What else a machine could take over: the time of a run on ever more equal machines is bounded by its largest island.
struct BalanceReport {
  double largest_share{};  ///< Cost of the most costly island over that of all
  double imbalance{};      ///< Cost of the busiest machine over the mean of all, less 1
  double with_one_more{};  ///< Predicted time with one more machine over the present one
  /// So many equal machines do the work in the time of the largest island, give or take a hundredth: more do not help.
  int useful_machines{1};
};

/// `cost`: of each island [time], `owner`: its machine. Speeds are taken into account.
[[nodiscard]] BalanceReport judge_balance(std::span<const double> cost, std::span<const MachineIndex> owner,
                                          std::span<const Machine> machines);

}  // namespace fexp::cluster
