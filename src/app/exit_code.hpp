// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace fexp::app {

enum class ExitCode : int {
  done = 0,
  different = 1,
  wrong_input = 2,
  fault = 3,
  output = 4,
  internal = 5,
  cluster = 6,
  hangup = 129,
  interrupted = 130,
  terminated = 143,
};

/// What each exit code means, as --help prints it.
inline constexpr std::array<std::pair<ExitCode, std::string_view>, 10> exit_codes{{
    {ExitCode::done, "done"},
    {ExitCode::different, "compare: the runs differ; crossings: surfaces cross; verify: a result is not as expected"},
    {ExitCode::wrong_input, "wrong input or command line; nothing was written"},
    {ExitCode::fault, "the run stopped for a physical reason; what came before it is readable"},
    {ExitCode::output, "output could not be written; what came before is readable"},
    {ExitCode::internal, "out of memory, or an error of fexp itself"},
    {ExitCode::cluster,
     "cluster: the run cannot go on by itself; \"fexp cluster resume\" goes on from the last snapshot"},
    {ExitCode::hangup, "ended by SIGHUP after closing all files"},
    {ExitCode::interrupted, "ended by Ctrl-C (SIGINT) after closing all files"},
    {ExitCode::terminated, "ended by SIGTERM after closing all files"},
}};

}  // namespace fexp::app
