// SPDX-License-Identifier: Apache-2.0
#include "base/process_threads.hpp"

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace fexp {

int process_threads(pid_t id) {
  int count = 0;
  std::error_code gone;
  std::filesystem::directory_iterator threads("/proc/" + std::to_string(id) + "/task", gone);
  while (!gone && threads != std::filesystem::directory_iterator()) {
    ++count;
    threads.increment(gone);
  }
  return count;
}

int process_threads() { return process_threads(getpid()); }

}  // namespace fexp
