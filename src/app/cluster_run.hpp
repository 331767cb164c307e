// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/exit_code.hpp"
#include "cluster/placement.hpp"

namespace fexp::app {

struct ClusterRunOptions {
  std::string deck;
  std::string hosts;
  std::string discover;
  std::string out;
  bool force{};
  int threads{};
  std::string agent;
  std::string mpirun;
  std::int64_t hash_every{};
  double checkpoint_seconds{60.0};
  cluster::PlacementRule placement{cluster::PlacementRule::fewest_elements};
  bool quiet{};
  bool json{};
  std::vector<std::string> events;
};

struct ClusterResumeOptions {
  std::string run;
  bool quiet{};
  bool json{};
};

/// The coordinator of a run, until the run's end. Both throw InputErrors before anything is written or launched.
[[nodiscard]] ExitCode cluster_run(const ClusterRunOptions& options);
[[nodiscard]] ExitCode cluster_resume(const ClusterResumeOptions& options);

}  // namespace fexp::app
