// SPDX-License-Identifier: Apache-2.0
#include "coordinator/places.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <system_error>

#include "io/output_error.hpp"

namespace fexp::coordinator {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t run_id_digits = 16;

/// Number of an interface's address as text; empty for other families.
std::string address_text(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address == nullptr) {
    return "";
  }
  const void* number = nullptr;
  if (address->sa_family == AF_INET) {
    number = &reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
  } else if (address->sa_family == AF_INET6) {
    number = &reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
  }
  return number != nullptr && inet_ntop(address->sa_family, number, text.data(), text.size()) != nullptr ? text.data()
                                                                                                         : "";
}

bool is_number_of_interface(std::string_view wanted) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    return false;
  }
  bool found = false;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    found = found || address_text(entry->ifa_addr) == wanted;
  }
  freeifaddrs(list);
  return found;
}

std::string_view before_dot(std::string_view name) { return name.substr(0, name.find('.')); }

bool is_number(std::string_view address) {
  return address.find_first_not_of("0123456789.") == std::string_view::npos || address.find(':') != address.npos;
}

}  // namespace

std::string new_run_id() {
  std::random_device random;
  const std::uint64_t high = random(), low = random();
  return fmt::format("{:016x}", high << 32U | (low & 0xffffffffU));
}

bool is_run_id(std::string_view text) {
  return text.size() == run_id_digits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

fs::path run_memory(std::string_view run_id) {
  return fs::path(fmt::format("/dev/shm/fexp-{}", getuid())) / std::string(run_id);
}

fs::path machine_memory(std::string_view run_id, std::string_view machine) {
  return run_memory(run_id) / std::string(machine);
}

fs::path heartbeat_file(std::string_view run_id, std::string_view machine) {
  return machine_memory(run_id, machine) / "alive";
}

fs::path snapshot_folder(std::string_view run_id, std::string_view machine) {
  return machine_memory(run_id, machine) / "snapshots";
}

fs::path worker_lock(std::string_view run_id, std::string_view machine) {
  return machine_memory(run_id, machine) / "lock";
}

void make_private_directory(const fs::path& path) {
  if (path.has_parent_path() && !fs::exists(path.parent_path())) {
    make_private_directory(path.parent_path());
  }
  const char* const cure = "make room for a directory of this name that belongs to you alone";
  if (mkdir(path.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    throw io::OutputError(path, "cannot create the directory: " + std::generic_category().message(errno), cure);
  }
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0 || !S_ISDIR(found.st_mode) || found.st_uid != getuid() ||
      (found.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw io::OutputError(path, "is not a directory that belongs to this user and is closed to others", cure);
  }
}

fs::path socket_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");      // NOLINT(concurrency-mt-unsafe)
  constexpr std::size_t name_bytes = 1 + run_id_digits + 5;  // "/RUNID.sock"
  if (runtime != nullptr && *runtime == '/' && access(runtime, W_OK | X_OK) == 0) {
    fs::path folder = fs::path(runtime) / "fexp";
    if (folder.string().size() + name_bytes <= longest_socket_path) {
      return folder;
    }
  }
  return fmt::format("/tmp/fexp-{}", getuid());
}

fs::path socket_file(std::string_view run_id) { return socket_folder() / fmt::format("{}.sock", run_id); }

std::string own_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name.front() != '\0' ? name.data() : "localhost";
}

bool is_own_address(std::string_view address) {
  if (address == "localhost" || address == "::1" || address.starts_with("127.")) {
    return true;
  }
  if (is_number(address)) {
    return is_number_of_interface(address);
  }
  const std::string own = own_name();
  // A name without its domain is the same machine's; two names with different domains are two machines.
  const bool one_is_short = address.find('.') == address.npos || own.find('.') == own.npos;
  return address == own || (one_is_short && before_dot(address) == before_dot(own));
}

}  // namespace fexp::coordinator
