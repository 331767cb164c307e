// SPDX-License-Identifier: Apache-2.0
#include "app/worker_link.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <utility>

namespace fexp::app {

namespace {

constexpr auto beat_after = std::chrono::milliseconds(200);
constexpr double farewell_seconds = 2.0;

}  // namespace

void WorkerLink::send(const nlohmann::json& message) {
  if (channel_) {
    channel_->send(message);
  }
}

void WorkerLink::finish() {
  if (channel_) {
    channel_->finish(farewell_seconds);
  }
}

void WorkerLink::poll() {
  while (channel_) {
    const std::optional<nlohmann::json> message = channel_->poll();
    if (!message) {
      return;
    }
    const std::string command = message->value("command", "");
    reform_ = reform_ || command == "reform";
    stop_ = stop_ || command == "stop";
  }
}

void WorkerLink::began_at(std::int64_t step) {
  std::erase_if(events_, [step](std::int64_t event) { return event <= step; });
}

bool WorkerLink::event_due(std::int64_t step) const noexcept {
  return std::ranges::any_of(events_, [step](std::int64_t event) { return event <= step; });
}

Heartbeat::Heartbeat(std::filesystem::path file) : file_(std::move(file)) {
  beat();
  thread_ = std::thread([this] {
    std::unique_lock lock(mutex_);
    while (!stop_.wait_for(lock, beat_after, [this] { return stopped_; })) {
      beat();
    }
  });
}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stop_.notify_all();
  thread_.join();
}

void Heartbeat::beat() const { std::ofstream(file_, std::ios::trunc) << "alive\n"; }

}  // namespace fexp::app
