// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

namespace fexp::bench {

/// Largest resident memory since the program was started, unlike getrusage's, which knows the parent's too.
inline double most_resident_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0.0;
  while (status >> word) {
    if (word == "VmHWM:") {
      status >> kilobytes;
    }
  }
  return 1024.0 * kilobytes;
}

}  // namespace fexp::bench
