// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "coordinator/line_connection.hpp"

namespace fexp::coordinator {

/// The coordinator's Unix socket: rank 0 of a world and the commands of this user connect to it, nobody else can.
class ControlServer {
 public:
  /// Listens. Throws OutputError. The socket is removed at the end.
  explicit ControlServer(std::filesystem::path socket);
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;
  ~ControlServer();

  struct Message {
    int client{};
    nlohmann::json content;
  };
  /// Takes in who connects and what has been said since the last call.
  [[nodiscard]] std::vector<Message> receive();
  /// Those who left since the last call.
  [[nodiscard]] std::vector<int> take_left();
  /// Nothing when the client is gone.
  void send(int client, const nlohmann::json& message);

  /// To poll for reading.
  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  void accept_all();

  std::filesystem::path path_;
  int listener_{-1};
  int next_client_{1};
  std::map<int, LineConnection> clients_;
  std::vector<int> left_;
};

}  // namespace fexp::coordinator
