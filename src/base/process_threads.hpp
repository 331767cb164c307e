// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

namespace fexp {

/// Threads of a process of this machine as the system counts them; 0 when there is no such process.
[[nodiscard]] int process_threads(pid_t id);
/// Of this process.
[[nodiscard]] int process_threads();

}  // namespace fexp
