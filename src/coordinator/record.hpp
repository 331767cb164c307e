// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "coordinator/machine.hpp"
#include "coordinator/membership.hpp"

namespace fexp::coordinator {

/// What the user asked for.
struct ClusterOptions {
  std::string deck;    ///< Absolute path
  std::string hosts;   ///< Hosts file, absolute path; empty: none
  std::string script;  ///< Script that lists the machines; empty: none
  std::string agent;   ///< Launch agent; empty: ssh
  std::string mpirun;  ///< More options of mpirun
  int threads{};
  std::int64_t hash_every{};
  double checkpoint_seconds{60.0};  ///< At least so long between two checkpoints on the disk
  std::string placement;            ///< Rule of placement, as the worker knows it
  bool quiet{};
};

/// The threads of a machine's process.
struct MachineThreads {
  std::string machine;
  int native{};     ///< Of the hardware
  int running{};    ///< As the system counts them
  int computing{};  ///< Of these
};

/// The threads of a world as they were when it had stepped its first epoch: the paper's table 2.
struct WorldThreads {
  std::vector<MachineThreads> machines;
  int coordinator{};
  int mpirun{};         ///< On the coordinator's machine
  int launch_agents{};  ///< One for each other machine
};

/// A world that was started.
struct WorldRecord {
  int world{};
  std::vector<std::string> machines;  ///< By rank
  std::string started;                ///< Date and time
  std::string ended;                  ///< Reason, or what it was lost for; empty while it lives
  WorldThreads threads;               ///< Without machines: it never stepped
};

/// cluster.json of a run: all that a new coordinator needs to go on.
struct ClusterRecord {
  std::string run_id;
  ClusterOptions options;
  std::vector<Machine> machines;  ///< Wanted
  std::vector<Machine> listed;    ///< Last list of the file or script
  std::vector<StepEvent> events;
  std::vector<WorldRecord> worlds;
  std::string state{"running"};  ///< "running", "completed", "fault", "stopped" or "gave up"
  std::string message;
  std::string host;    ///< Of the coordinator
  std::int64_t pid{};  ///< Of the coordinator
  std::string socket;

  [[nodiscard]] int next_world() const { return worlds.empty() ? 1 : worlds.back().world + 1; }
};

[[nodiscard]] std::filesystem::path record_file(const std::filesystem::path& run);

[[nodiscard]] nlohmann::ordered_json to_json(const ClusterRecord& record);
/// Replaces RUN/cluster.json. Throws OutputError.
void write_record(const std::filesystem::path& run, const ClusterRecord& record);
/// Throws InputErrors when the directory is no run of a cluster.
[[nodiscard]] ClusterRecord read_record(const std::filesystem::path& run);

/// Held by the coordinator of a run as long as it lives; the system takes it from a process that is killed.
class RunLock {
 public:
  /// Throws InputErrors when another coordinator lives, and OutputError.
  explicit RunLock(const std::filesystem::path& run);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  int descriptor_;
};

}  // namespace fexp::coordinator
