// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/machine.hpp"

namespace fexp::coordinator {

/// All that mpirun's command line depends on.
struct WorldLaunch {
  std::string run_id;
  int world{};
  std::vector<Machine> ranks;  ///< By rank
  bool writer_only{};          ///< Rank 0 computes nothing
  std::string socket;
  int threads{};                    ///< On every machine; 0: its slots, or what it has
  std::string agent;                ///< Launch agent with its options; empty: ssh
  std::string options;              ///< More options of mpirun, separated by blanks
  std::vector<std::string> worker;  ///< The program, and what comes before "worker"
};

/// Words separated by blanks.
[[nodiscard]] std::vector<std::string> split_words(std::string_view text);

/// The launch agent asks nothing and gives up in time: "ssh" becomes ssh with options for that.
[[nodiscard]] std::string agent_or_ssh(std::string_view agent);

/// mpirun's command line for a world: an application context for each rank, so that each knows its machine's name
/// (FEXP_HOST) whatever the name server says.
[[nodiscard]] std::vector<std::string> mpirun_command(const WorldLaunch& launch);

/// A command line that runs `words` on a machine: through the agent, whose remote end takes a line for a shell, or
/// directly on this one.
[[nodiscard]] std::vector<std::string> remote_command(std::string_view agent, const Machine& machine, bool is_own,
                                                      const std::vector<std::string>& words);

/// What mpirun said before it ended, in plain words.
struct LaunchFailure {
  std::optional<int> rank;  ///< That failed
  bool killed{};            ///< From outside, by SIGKILL or SIGTERM
  std::string words;
};
/// `output` is the end of mpirun's output, `status` tells how it ended ("exit code 1").
[[nodiscard]] LaunchFailure explain_launch_failure(std::string_view output, std::string_view status,
                                                   const std::vector<Machine>& ranks);

}  // namespace fexp::coordinator
