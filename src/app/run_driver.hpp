// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "app/exit_code.hpp"
#include "app/load.hpp"
#include "app/memory_snapshots.hpp"
#include "app/output_mark.hpp"
#include "app/ranks.hpp"
#include "app/time_loop.hpp"
#include "app/worker_link.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

struct DriveSettings {
  WorldSettings world;
  std::int64_t hash_every{};
  solve::KernelChoice kernel{solve::KernelChoice::automatic};
  double checkpoint_seconds{60.0};  ///< At least so long between two checkpoints on the disk
  bool quiet{};
  bool json{};
};

/// Where a run goes on.
struct TakenUp {
  std::vector<Bytes> pieces;  ///< Of this rank
  OutputMark mark;
};

/// A run, or one world of it, with all it needs.
struct Drive {
  Ranks& ranks;
  const Case& loaded;
  const io::RunDirectory& directory;  ///< Made already; used on rank 0
  DriveSettings settings;
  std::optional<TakenUp> taken_up{};
  std::function<void(std::int64_t step)> before_output{};  ///< On rank 0, before files are begun or cut back
  WorkerLink* link{};                                      ///< For a worker of a cluster run, with the next
  MemorySnapshots* snapshots{};
};

/// Runs to the end, all ranks together, and writes the summary; says on stdout and stderr what the user is to know.
/// Returns the exit code on rank 0, done on the others. `end.reason` is the same on all.
[[nodiscard]] ExitCode drive(const Drive& run, RunEnd& end);

/// Removes what this rank has saved of a run that is over, once everybody who waits for the end knows of it: without
/// it, whoever does not know would begin again.
void clear_saved(const Drive& run, const RunEnd& end);

}  // namespace fexp::app
