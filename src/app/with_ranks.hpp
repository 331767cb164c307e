// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "app/exit_code.hpp"
#include "app/ranks.hpp"

namespace fexp::app {

/// Joins the ranks of the world that this process belongs to, runs `work` with so many threads (0: this rank's fair
/// share), and leaves them. What `work` throws alone on this rank, while the others wait for it, ends them all.
[[nodiscard]] ExitCode with_ranks(int threads, const std::function<ExitCode(Ranks&)>& work);

}  // namespace fexp::app
