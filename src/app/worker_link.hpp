// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/control_channel.hpp"

namespace fexp::app {

/// A worker's tie to the coordinator. Rank 0 talks to it; the others know from rank 0 what it said.
class WorkerLink {
 public:
  /// `channel`: of rank 0; none elsewhere. `events`: steps at whose boundaries the world ends, the same on all ranks.
  WorkerLink(std::optional<coordinator::ControlClient> channel, std::vector<std::int64_t> events)
      : channel_(std::move(channel)), events_(std::move(events)) {}

  void send(const nlohmann::json& message);
  void finish();
  /// Takes in what the coordinator has said.
  void poll();
  [[nodiscard]] bool reform_wanted() const noexcept { return reform_; }
  [[nodiscard]] bool stop_wanted() const noexcept { return stop_; }
  [[nodiscard]] bool lost() const noexcept { return channel_ && channel_->lost(); }
  /// An event is due that was not when the world began.
  [[nodiscard]] bool event_due(std::int64_t step) const noexcept;
  void began_at(std::int64_t step);

 private:
  std::optional<coordinator::ControlClient> channel_;
  std::vector<std::int64_t> events_;
  bool reform_{};
  bool stop_{};
};

/// Shows that this process is not frozen: a thread of its own touches a file several times a second.
class Heartbeat {
 public:
  explicit Heartbeat(std::filesystem::path file);
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  ~Heartbeat();

 private:
  void beat() const;

  std::filesystem::path file_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopped_{};
  std::thread thread_;
};

}  // namespace fexp::app
