// SPDX-License-Identifier: Apache-2.0
#include "coordinator/control_channel.hpp"

#include <chrono>
#include <thread>

namespace fexp::coordinator {

ControlClient::ControlClient(const std::filesystem::path& socket, int world) : connection_(connect_to(socket)) {
  send({{"hello", "world"}, {"world", world}});
}

void ControlClient::send(const nlohmann::json& message) {
  if (connection_) {
    connection_->send(message);
  }
}

std::optional<nlohmann::json> ControlClient::poll() { return connection_ ? connection_->poll() : std::nullopt; }

std::optional<nlohmann::json> ControlClient::wait(double seconds) {
  return connection_ ? wait_for_message(*connection_, seconds) : std::nullopt;
}

void ControlClient::finish(double seconds) {
  using namespace std::chrono_literals;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (connection_ && connection_->has_unsent() && std::chrono::steady_clock::now() < end) {
    connection_->flush();
    std::this_thread::sleep_for(1ms);
  }
}

bool ControlClient::lost() const noexcept { return !connection_ || connection_->lost(); }

}  // namespace fexp::coordinator
