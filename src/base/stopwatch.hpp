// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fexp {

/// A clock that never goes back.
using Clock = std::chrono::steady_clock;

/// Wall time since `start` [s].
[[nodiscard]] inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace fexp
