// SPDX-License-Identifier: Apache-2.0
#include "coordinator/control_server.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "coordinator/places.hpp"
#include "io/output_error.hpp"

namespace fexp::coordinator {

ControlServer::ControlServer(std::filesystem::path socket) : path_(std::move(socket)) {
  make_private_directory(path_.parent_path());
  const std::string path = path_.string();
  const auto fail = [&](int error) {
    throw io::OutputError(path_, "cannot listen there: " + std::generic_category().message(error),
                          "set XDG_RUNTIME_DIR to a short path of a directory that belongs to you");
  };
  if (path.size() > longest_socket_path) {
    fail(ENAMETOOLONG);
  }
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(path, std::begin(address.sun_path));
  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  // What a killed coordinator of the same run left; a living one holds the lock of the run.
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  constexpr int waiting = 16;
  if (listener_ < 0 || bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0 || listen(listener_, waiting) != 0) {
    const int error = errno;
    if (listener_ >= 0) {
      close(listener_);
    }
    fail(error);
  }
}

ControlServer::~ControlServer() {
  for (auto& [id, client] : clients_) {
    client.flush();
  }
  close(listener_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void ControlServer::accept_all() {
  while (true) {
    const int descriptor = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor < 0) {
      return;
    }
    ucred user{};
    socklen_t size = sizeof(user);
    LineConnection client(descriptor);
    if (getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &user, &size) == 0 && user.uid == getuid()) {
      clients_.emplace(next_client_++, std::move(client));
    }
  }
}

std::vector<ControlServer::Message> ControlServer::receive() {
  accept_all();
  std::vector<Message> messages;
  for (auto& [id, client] : clients_) {
    while (auto content = client.poll()) {
      messages.push_back({id, std::move(*content)});
    }
    if (client.lost()) {
      left_.push_back(id);
    }
  }
  std::erase_if(clients_, [](const auto& client) { return client.second.lost(); });
  return messages;
}

std::vector<int> ControlServer::take_left() { return std::exchange(left_, {}); }

void ControlServer::send(int client, const nlohmann::json& message) {
  const auto found = clients_.find(client);
  if (found != clients_.end()) {
    found->second.send(message);
  }
}

std::vector<int> ControlServer::descriptors() const {
  std::vector<int> all{listener_};
  for (const auto& [id, client] : clients_) {
    all.push_back(client.descriptor());
  }
  return all;
}

}  // namespace fexp::coordinator
