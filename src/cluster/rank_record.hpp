// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "cluster/epoch_report.hpp"
#include "solve/island_solver.hpp"

namespace fexp::cluster {

/// What a rank tells the others of an attempt at an epoch, and what all of them together come to. Sums and extremes of
/// whole numbers and exact extremes of others, so the order of ranks does not matter.
struct RankRecord {
  Index good_steps{std::numeric_limits<Index>::max()};  ///< That all islands have done
  bool left_box{};
  Index broken_steps{};  ///< Good steps before the first velocity that is not finite
  Index broken_node{no_index};
  double contact_frequency2{};
  Index stiffest_node{no_index};  ///< See IslandReport
  Index stiffest_element{no_index};
  Index stiffest_wall{no_index};
  Index active_pairs{};
  Index candidates{};
  Index searches{};
  double deepest{};
  Index deepest_node{no_index};
  Index deepest_element{no_index};
  Requests requests;
  std::int64_t moved_bytes{};  ///< Of bodies that changed their rank
  std::int64_t messages{};     ///< Sent since the record before
  std::int64_t message_bytes{};
  double busy_seconds{};     ///< Spent stepping
  double waiting_seconds{};  ///< Spent in the communicator since the record before; of several ranks the sum
  int running_threads{};     ///< Of the process, computing or not; 0: not counted this time

  void add(const solve::IslandReport& island);
  void add(const RankRecord& other);
};

}  // namespace fexp::cluster
