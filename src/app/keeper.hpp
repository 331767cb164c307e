// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/memory_snapshots.hpp"
#include "app/run_output.hpp"
#include "app/save_clock.hpp"
#include "app/worker_link.hpp"
#include "cluster/simulation.hpp"
#include "io/checkpoint_files.hpp"

namespace fexp::app {

/// Looks after a run between its epochs: asks for what is due, and saves the state where it was asked for, on the disk
/// and, in a cluster run, in the memory of the machines.
class Keeper {
 public:
  struct Settings {
    std::filesystem::path checkpoints;  ///< Directory, of rank 0
    double checkpoint_seconds{60.0};    ///< At least so long between two checkpoints
    std::int64_t hash_every{};
  };
  explicit Keeper(Settings settings) : settings_(std::move(settings)), disk_clock_(settings_.checkpoint_seconds) {}

  /// For a worker of a cluster run. Both outlive the keeper.
  void serve(WorkerLink& link, MemorySnapshots& snapshots);

  /// What this rank asks for at the end of the next epoch.
  [[nodiscard]] cluster::Requests ask(const cluster::Simulation& simulation);
  /// After an epoch and its outputs, all ranks together: saves what any rank has asked for. `output`: on rank 0 alone,
  /// and null when the files have failed. Throws OutputError on rank 0.
  void keep(cluster::Simulation& simulation, const cluster::Requests& asked, RunOutput* output);
  /// True at the first end of an epoch at or after a step at which the coordinator has an event: the same on all ranks.
  [[nodiscard]] bool event_due(const cluster::Simulation& simulation) const;

  [[nodiscard]] WorkerLink* link() noexcept { return link_; }
  [[nodiscard]] const SaveClock& memory_clock() const noexcept { return memory_clock_; }
  [[nodiscard]] const SaveClock& disk_clock() const noexcept { return disk_clock_; }

 private:
  void save_on_disk(cluster::Simulation& simulation, RunOutput* output);
  void save_in_memory(cluster::Simulation& simulation, RunOutput* output);

  Settings settings_;
  SaveClock disk_clock_;
  SaveClock memory_clock_{0.5};
  WorkerLink* link_{};
  MemorySnapshots* snapshots_{};
};

}  // namespace fexp::app
