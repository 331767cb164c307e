// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/saved_run.hpp"
#include "app/take_ups.hpp"
#include "cluster/simulation.hpp"

namespace fexp::app {

/// Snapshots in files that live in memory and outlive a world: each rank keeps the part of its own machine, and the
/// part of the machine before it in the ring (its buddy's), so that the loss of any one machine loses nothing. The
/// newest two moments are kept, because one may be lost while it is being written.
class MemorySnapshots {
 public:
  /// `folder`: this rank's own. `host`: what may be lost at once with this rank. All ranks together.
  MemorySnapshots(std::filesystem::path folder, const std::string& host, cluster::Communicator& communicator);

  /// What distinguishes this world's moments from those that other worlds saved at the same step: TakeUps::count().
  void belong_to(std::int64_t history) noexcept { history_ = history; }

  /// All ranks together, at an epoch's start. `mark`: rank 0's counts; nothing is saved when rank 0 has none.
  void save(const cluster::Simulation& simulation, std::int64_t hash_every, const std::optional<OutputMark>& mark);

  /// The newest moment of which all parts are somewhere, as far as this rank has them and no lower rank does, and that
  /// the run's files still have. All ranks together; none when there is no such moment.
  struct Found {
    std::int64_t step{};
    std::vector<SavedRun> parts;
    SavedRun about;  ///< Of one part, without its piece: the same on all ranks
  };
  [[nodiscard]] std::optional<Found> newest(const TakeUps& take_ups) const;

  /// Removes all that this rank has.
  void clear() const;

 private:
  [[nodiscard]] std::vector<SavedRun> present() const;
  void write(const SavedRun& saved) const;
  void remove_older(std::int64_t step) const;

  std::filesystem::path folder_;
  std::int64_t history_{};
  cluster::Communicator& communicator_;
  int buddy_{};                ///< The rank that keeps this one's part
  std::vector<int> kept_for_;  ///< The ranks whose parts this one keeps
};

}  // namespace fexp::app
