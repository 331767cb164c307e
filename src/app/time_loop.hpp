// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/keeper.hpp"
#include "app/load.hpp"
#include "app/progress.hpp"
#include "app/run_output.hpp"
#include "cluster/simulation.hpp"

namespace fexp::app {

/// reform: another world of machines is to go on.
enum class EndReason { completed, fault, interrupted, output_error, reform };

/// In words: "output error".
[[nodiscard]] const char* name_of(EndReason reason) noexcept;

/// Why a run, or a world of it, ended, and where it stood.
struct RunEnd {
  EndReason reason{EndReason::completed};
  std::string message;        ///< One sentence when it was not completed
  cluster::Fault fault;       ///< For EndReason::fault
  int signal{};               ///< For EndReason::interrupted
  cluster::EpochReport last;  ///< Of the last epoch
  double stepping_seconds{};  ///< Wall time without output, of this process
  std::int64_t first_step{};  ///< At which this process began
  std::int64_t last_step{};
};

/// What the loop works with. `output` is there on rank 0 alone.
struct LoopParts {
  const Case& loaded;
  std::int64_t hash_every{};
  cluster::Simulation& simulation;
  RunOutput* output{};
  Progress& progress;
  Keeper& keeper;
  bool resumed{};                        ///< The state has been written as far as its outputs were due
  std::optional<std::string> failure{};  ///< Why the files could not be opened
};

/// Steps from the present time to the end of the duration, or until a fault, a signal or another request, and writes
/// frames and rows at the deck's output times, at the start and at the end. All ranks together; afterwards rank 0 has
/// the whole state, unless another world is to go on. Files that cannot be written end the run on all ranks, with
/// EndReason::output_error.
void run_time_loop(const LoopParts& parts, RunEnd& end);

}  // namespace fexp::app
