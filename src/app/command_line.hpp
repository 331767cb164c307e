// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp::app {

/// Reads the command line, carries out its command, reports whatever goes wrong on stderr, and returns the exit code.
[[nodiscard]] int run_command_line(int argc, const char* const* argv) noexcept;

}  // namespace fexp::app
