// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "coordinator/line_connection.hpp"

namespace fexp::coordinator {

/// The end of rank 0 of a world. It is greeted with
///   {"run": directory, "deck": path, "deck_copy": path, "run_id": ..., "world": n, "machines": [names by rank],
///    "writer_only": bool, "events": [steps], "options": {"hash_every": n, "checkpoint_seconds": t,
///    "placement": rule, "threads": n, "quiet": bool}},
/// or with {"error": text} when the coordinator does not know this world: the worker ends then.
///
/// It sends
///   {"event": "started", "step": n, "time": t}     the state is there, stepping begins
///   {"event": "status", "step": n, "time": t, ...} after every epoch; whatever else is in it, "cluster status" shows
///   {"event": "ended", "reason": r, "exit_code": n, "message": text, "step": n} before it leaves, r being "completed",
///       "reform", "fault", "interrupted", "output_error" or "lost_coordinator"
/// and is told {"command": "reform"} and {"command": "stop"}: end the world at the next boundary of epochs with reason
/// "reform" or "interrupted". A world ends with "reform" by itself at the first boundary at or after each of "events".
class ControlClient {
 public:
  /// Connects to the coordinator and says which world this is. Nobody there: the channel is lost from the start.
  ControlClient(const std::filesystem::path& socket, int world);

  /// Never waits, and does nothing once the channel is lost.
  void send(const nlohmann::json& message);
  /// The next message of the coordinator, if there is one. Never waits.
  [[nodiscard]] std::optional<nlohmann::json> poll();
  /// The next message, waited for at most so long [s]; for the greeting.
  [[nodiscard]] std::optional<nlohmann::json> wait(double seconds);
  /// Sends what waits to be sent for at most so long [s]; before the worker leaves.
  void finish(double seconds);
  /// The coordinator is gone. Known after a poll.
  [[nodiscard]] bool lost() const noexcept;

 private:
  std::optional<LineConnection> connection_;
};

}  // namespace fexp::coordinator
