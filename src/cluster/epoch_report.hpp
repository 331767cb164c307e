// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cluster/fault.hpp"
#include "solve/diagnostics.hpp"
#include "solve/island_solver.hpp"

namespace fexp::cluster {

/// What a rank asks all others for at the end of an epoch. What one asks for, all do.
struct Requests {
  bool reform{};        ///< End this world, because other machines are to make the next one
  bool stop{};          ///< End the run here
  bool output_error{};  ///< End the run here, because its files cannot be written
  bool snapshot{};      ///< Keep the state in the machines' memory
  bool checkpoint{};    ///< Keep the state on the disk

  Requests& operator|=(const Requests& other) noexcept {
    reform = reform || other.reform;
    stop = stop || other.stop;
    output_error = output_error || other.output_error;
    snapshot = snapshot || other.snapshot;
    checkpoint = checkpoint || other.checkpoint;
    return *this;
  }
};

/// What one epoch did. The same on every rank, but for the hashes.
struct EpochReport {
  double dt{};  ///< [time]
  Index steps{};
  Index islands{};
  Index largest_island_elements{};
  Index rollbacks{};     ///< Times the epoch was put back and redone
  double end_time{};     ///< Where the last attempt was to end [time]
  Index active_pairs{};  ///< Contacts at the end
  Index candidates{};
  Index searches{};  ///< Contact searches during the epoch
  double deepest{};  ///< Deepest penetration over contact distance [-]
  Index deepest_node{no_index};
  Index deepest_element{no_index};
  double contact_frequency2{};    ///< Bound of contact's and walls' share of omega^2 [1/time^2]
  Index stiffest_node{no_index};  ///< Of the pair that has it
  Index stiffest_element{no_index};
  Index stiffest_wall{no_index};   ///< Instead of an element
  solve::CriticalStep critical;    ///< Of the elements, at the end
  solve::Diagnostics diagnostics;  ///< At the end
  double energy_error{};           ///< Relative imbalance at the end [-]
  double linear_momentum_error{};  ///< Relative to the sum of moduli [-]
  double angular_momentum_error{};
  std::vector<solve::HashRecord> hashes;  ///< By step, then body; on rank 0 only.
  Fault fault;
  Fault retried;      ///< Why the epoch was done again with half the step, if it was
  Requests requests;  ///< Of all ranks
};

/// Largest values over the run.
struct RunExtremes {
  double energy_error{};
  double linear_momentum_error{};
  double angular_momentum_error{};
  double smallest_dt{HUGE_VAL};
  double largest_dt{};
  Index fewest_islands{};
  Index most_islands{};
  Index most_active_pairs{};
  double deepest{};
  std::int64_t epochs{};
  std::int64_t rollbacks{};
  std::int64_t retries{};  ///< Epochs that were done again with half the step
  std::int64_t searches{};

  void add(const EpochReport& report);
};

}  // namespace fexp::cluster
