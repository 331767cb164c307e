// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cluster/communicator.hpp"

namespace fexp::cluster {

/// True when mpirun, srun or another launcher of MPI programs has started this process.
[[nodiscard]] bool is_mpi_process();

/// MPI from its start to its end: one at a time, and only in a process that is_mpi_process(). Where other ranks share
/// the machine and its cores, waiting ranks let others work.
class MpiWorld {
 public:
  MpiWorld();
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;
  /// Waits for all ranks.
  ~MpiWorld();

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int size() const noexcept { return size_; }
  /// Ranks of this world that share this rank's machine, itself included, and its number among them.
  [[nodiscard]] int machine_size() const noexcept { return machine_size_; }
  [[nodiscard]] int machine_rank() const noexcept { return machine_rank_; }

  /// All ranks of the world; to be used and destroyed before this.
  [[nodiscard]] std::unique_ptr<Communicator> communicator() const;

  /// Ends all ranks at once, without waiting for any.
  [[noreturn]] static void abort(int exit_code);

 private:
  int rank_{};
  int size_{1};
  int machine_size_{1};
  int machine_rank_{};
};

/// Processor cores that this process may use by itself: those of its affinity, or when that is the whole machine, its
/// share among the ranks there. At least 1.
[[nodiscard]] int fair_threads(int machine_size, int machine_rank);

}  // namespace fexp::cluster
