// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "app/load.hpp"
#include "cluster/simulation.hpp"

namespace fexp::app {

/// What a short trial of a run shows; nothing is written.
struct Trial {
  std::int64_t steps{};
  double time{};              ///< Simulated [time]
  double seconds{};           ///< Wall time of the steps
  double expected_steps{};    ///< Of the whole run, at the trial's mean step
  double expected_seconds{};  ///< Wall time of the whole run without output
  double element_steps_per_second{};
  double memory_bytes{};  ///< Largest so far
  /// Bodies that touch each other before anything moves, by the energy stored in that, ascending.
  std::vector<Index> touching;
  cluster::EpochReport last;  ///< Of the last epoch
};

/// Steps as a run does, with its output times, for about `seconds` of wall time.
[[nodiscard]] Trial run_trial(const Case& loaded, double seconds);

}  // namespace fexp::app
