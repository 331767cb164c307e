// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "app/exit_code.hpp"

namespace fexp::app {

/// A command of the program: "fexp NAME ...".
struct Command {
  const char* name;
  const char* purpose;   ///< One line
  const char* examples;  ///< Lines for --help
  /// Declares the options; returns what carries the command out once they are parsed.
  std::function<ExitCode()> (*declare)(CLI::App& options);
  bool hidden{};  ///< Started by fexp itself, not by users
};

// To add a command: its own file that defines it, its line here, and its line in the table in command_line.cpp.
extern const Command run_command;
extern const Command check_command;
extern const Command info_command;
extern const Command compare_command;
extern const Command crossings_command;
extern const Command bench_command;
extern const Command reference_command;
extern const Command cluster_command;
extern const Command probe_command;
extern const Command resume_command;
extern const Command verify_command;
extern const Command worker_command;

}  // namespace fexp::app
