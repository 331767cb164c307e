// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "app/load.hpp"
#include "app/progress.hpp"
#include "app/run_output.hpp"
#include "cluster/simulation.hpp"

namespace fexp::app {

enum class EndReason { completed, fault, interrupted, output_error };

/// Why a run ended, and where it stood.
struct RunEnd {
  EndReason reason{EndReason::completed};
  std::string message;        ///< One sentence when it was not completed
  cluster::Fault fault;       ///< For EndReason::fault
  int signal{};               ///< For EndReason::interrupted
  cluster::EpochReport last;  ///< Of the last epoch
  double stepping_seconds{};  ///< Wall time without output
};

/// Steps from the present time to the end of the duration, or until a fault or a signal, and writes frames and rows at
/// the deck's output times, at the start and at the end. `end` is up to date even when an OutputError leaves the loop.
void run_time_loop(const Case& loaded, std::int64_t hash_every, cluster::Simulation& simulation, RunOutput& output,
                   Progress& progress, RunEnd& end);

}  // namespace fexp::app
