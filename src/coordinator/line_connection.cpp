// SPDX-License-Identifier: Apache-2.0
#include "coordinator/line_connection.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "coordinator/places.hpp"

namespace fexp::coordinator {

namespace {

/// More without an end of line is not what either end sends.
constexpr std::size_t longest_line = std::size_t{4} << 20U;

bool would_wait(int error) { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace

LineConnection::LineConnection(int descriptor) : descriptor_(descriptor) {
  const int flags = fcntl(descriptor_, F_GETFL);
  static_cast<void>(fcntl(descriptor_, F_SETFL, flags | O_NONBLOCK));
  static_cast<void>(fcntl(descriptor_, F_SETFD, FD_CLOEXEC));
}

LineConnection::LineConnection(LineConnection&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      closed_(other.closed_),
      received_(std::move(other.received_)),
      unsent_(std::move(other.unsent_)) {}

LineConnection& LineConnection::operator=(LineConnection&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(closed_, other.closed_);
  std::swap(received_, other.received_);
  std::swap(unsent_, other.unsent_);
  return *this;
}

LineConnection::~LineConnection() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

void LineConnection::send(const nlohmann::json& message) {
  unsent_ += message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  flush();
}

void LineConnection::flush() {
  while (!unsent_.empty() && !closed_) {
    const ssize_t sent = ::send(descriptor_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      unsent_.erase(0, static_cast<std::size_t>(sent));
    } else if (would_wait(errno)) {
      return;
    } else if (errno != EINTR) {
      // What the other end sent before it went may still be read, so the connection is not closed here.
      unsent_.clear();
    }
  }
}

void LineConnection::receive() {
  std::array<char, 65536> bytes{};
  while (!closed_) {
    const ssize_t count = recv(descriptor_, bytes.data(), bytes.size(), 0);
    if (count > 0) {
      received_.append(bytes.data(), static_cast<std::size_t>(count));
    } else if (count < 0 && would_wait(errno)) {
      return;
    } else if (count == 0 || errno != EINTR) {
      closed_ = true;
    }
  }
}

std::optional<nlohmann::json> LineConnection::poll() {
  flush();
  if (received_.find('\n') == std::string::npos) {
    receive();
  }
  const std::size_t end = received_.find('\n');
  if (end == std::string::npos) {
    closed_ = closed_ || received_.size() > longest_line;
    return std::nullopt;
  }
  nlohmann::json message =
      nlohmann::json::parse(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
  received_.erase(0, end + 1);
  if (!message.is_object()) {
    closed_ = true;
    received_.clear();
    return std::nullopt;
  }
  return message;
}

bool LineConnection::lost() const noexcept { return closed_ && received_.find('\n') == std::string::npos; }

std::optional<LineConnection> connect_to(const std::filesystem::path& socket) {
  const std::string path = socket.string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() > longest_socket_path) {
    return std::nullopt;
  }
  std::ranges::copy(path, std::begin(address.sun_path));
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) {
    return std::nullopt;
  }
  LineConnection connection(descriptor);
  if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return std::nullopt;
  }
  return connection;
}

std::optional<nlohmann::json> wait_for_message(LineConnection& connection, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    if (auto message = connection.poll()) {
      return message;
    }
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    if (connection.lost() || left <= 0.0) {
      return std::nullopt;
    }
    pollfd waiting{connection.descriptor(), POLLIN, 0};
    if (connection.has_unsent()) {
      waiting.events |= POLLOUT;
    }
    constexpr double milliseconds = 1000.0;
    static_cast<void>(::poll(&waiting, 1, static_cast<int>(left * milliseconds) + 1));
  }
}

}  // namespace fexp::coordinator
