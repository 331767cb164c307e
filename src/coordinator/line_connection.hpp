// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace fexp::coordinator {

/// One end of a Unix socket over which messages go, each a JSON object on a line of its own. Never waits.
class LineConnection {
 public:
  /// Takes the descriptor over.
  explicit LineConnection(int descriptor);
  LineConnection(LineConnection&& other) noexcept;
  LineConnection& operator=(LineConnection&& other) noexcept;
  LineConnection(const LineConnection&) = delete;
  LineConnection& operator=(const LineConnection&) = delete;
  ~LineConnection();

  /// What the socket does not take now goes with a later call.
  void send(const nlohmann::json& message);
  /// The next whole message, if there is one. Text that is no JSON object ends the connection.
  [[nodiscard]] std::optional<nlohmann::json> poll();
  /// Sends what waits.
  void flush();

  /// The other end is gone, and all it sent has been taken.
  [[nodiscard]] bool lost() const noexcept;
  [[nodiscard]] bool has_unsent() const noexcept { return !unsent_.empty(); }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  void receive();

  int descriptor_;
  bool closed_{};
  std::string received_;
  std::string unsent_;
};

/// Connects to a coordinator's socket; none when nobody listens there.
[[nodiscard]] std::optional<LineConnection> connect_to(const std::filesystem::path& socket);

/// Waits for a message at most so long [s]; none when it did not come or the other end is gone.
[[nodiscard]] std::optional<nlohmann::json> wait_for_message(LineConnection& connection, double seconds);

}  // namespace fexp::coordinator
