// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fexp::coordinator {

/// What a machine tells of itself and of a run on it.
struct Probe {
  std::string version;                  ///< Of fexp there
  std::string kernel;                   ///< Element kernel it would use
  std::string machine;                  ///< The name that the run has for it
  std::string system_name;              ///< The name that it has for itself
  bool has_mpi{};                       ///< Open MPI's launch daemon is found
  int threads{};                        ///< Of the hardware
  std::int64_t memory_free{};           ///< Bytes; 0: not known
  std::optional<double> heartbeat_age;  ///< [s]; none: no worker of the run was here
  std::vector<std::string> snapshots;   ///< Names of files, sorted
  int killed{};                         ///< Workers ended
  bool has_worker{};                    ///< A worker of the run lives there, for this machine, and is not stopped
};

/// What is to be done before a machine tells of itself.
struct ProbeRequest {
  std::string run_id;
  std::string machine;
  std::optional<int> kill_below;  ///< End the run's workers of worlds below this one
  bool forget{};                  ///< Remove what the run keeps in memory for this machine
};

/// Looks at this machine. Ends workers only by the request: programs of this user whose command line has "worker",
/// "--run-id", the run's id, "--world" and a smaller number in sequence, and the launch daemon above them.
[[nodiscard]] Probe probe_here(const ProbeRequest& request, std::string_view kernel);

[[nodiscard]] nlohmann::json to_json(const Probe& probe);
/// None when the text has no such answer; what a shell's start-up files print before it is passed over.
[[nodiscard]] std::optional<Probe> read_probe(std::string_view text);

/// The world whose worker has this command line; none when it is no worker of the run.
[[nodiscard]] std::optional<int> world_of_worker(const std::vector<std::string>& words, std::string_view run_id);

}  // namespace fexp::coordinator
