// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/load.hpp"
#include "cluster/mpi_world.hpp"
#include "cluster/simulation.hpp"
#include "io/input_files.hpp"

namespace fexp::app {

/// How this process takes part in a world.
struct WorldSettings {
  int threads{};       ///< That compute; 0: this rank's fair share of the machine
  bool writer_only{};  ///< Rank 0 computes nothing
  cluster::PlacementRule rule{cluster::PlacementRule::fewest_elements};
  double latency_seconds{};  ///< Added to every message, to see what a slow network does
};

/// This process among the ranks of its world: one of several when an MPI launcher has started it, otherwise alone, and
/// then nothing of MPI starts.
class Ranks {
 public:
  Ranks();

  [[nodiscard]] int rank() const noexcept { return mpi_ ? mpi_->rank() : 0; }
  [[nodiscard]] int size() const noexcept { return mpi_ ? mpi_->size() : 1; }
  [[nodiscard]] bool is_first() const noexcept { return rank() == 0; }
  [[nodiscard]] bool several() const noexcept { return size() > 1; }

  /// Threads that compute on this rank.
  [[nodiscard]] int threads(int asked) const;
  /// Makes the world; all ranks together. Machines are named after their hosts, or as the environment says (FEXP_HOST).
  /// Refuses ranks that are of another version of fexp.
  [[nodiscard]] cluster::World join(const WorldSettings& settings);
  [[nodiscard]] cluster::Communicator& communicator() { return *communicator_; }

  /// Rank 0's bytes on all ranks.
  [[nodiscard]] Bytes from_first(std::span<const std::byte> bytes);
  /// True on all ranks when it is on all.
  [[nodiscard]] bool all(bool good);

  /// Runs `work` on rank 0 alone. What it throws is thrown there, and EndedElsewhere on the others.
  void on_first(const std::function<void()>& work);

  /// The case on all ranks; the files are read on rank 0 alone. Throws InputErrors there, and EndedElsewhere on others.
  [[nodiscard]] Case load(const std::filesystem::path& deck, io::InputFiles& files);

 private:
  std::optional<cluster::MpiWorld> mpi_;
  std::shared_ptr<cluster::Communicator> communicator_;
};

/// Another rank has found why the run cannot go on, and says so.
struct EndedElsewhere {};

/// This machine's name in a cluster run.
[[nodiscard]] std::string machine_name();

}  // namespace fexp::app
