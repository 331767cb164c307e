// SPDX-License-Identifier: Apache-2.0
#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "app/command.hpp"
#include "app/print.hpp"
#include "base/errors.hpp"
#include "io/output_error.hpp"
#include "io/similar_names.hpp"

namespace fexp::app {

namespace {

constexpr std::array commands{&run_command,     &resume_command,    &check_command,  &info_command,
                              &compare_command, &crossings_command, &bench_command,  &reference_command,
                              &cluster_command, &probe_command,     &verify_command, &worker_command};

void complain(const std::string& text) { print_error(fmt::format("fexp: {}\n", text)); }

std::string exit_code_text() {
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : exit_codes) {
    text += fmt::format("  {:<5}{}\n", static_cast<int>(code), meaning);
  }
  return text;
}

std::string overview_footer() {
  std::string text = "\nExamples:\n";
  for (const Command* command : commands) {
    text += command->hidden ? "" : fmt::format("{}\n", command->examples);
  }
  return text + "\n\"fexp COMMAND --help\" tells a command's options.\n\n" + exit_code_text();
}

/// ", did you mean A or B?", or nothing.
std::string suggestion(const std::string& wanted, const std::vector<std::string>& known) {
  const std::vector<std::string> similar = io::similar_names(wanted, known);
  return similar.empty() ? "" : fmt::format("; did you mean {}?", fmt::join(similar, " or "));
}

/// All, or those that users call.
std::vector<std::string> command_names(bool hidden_too) {
  std::vector<std::string> names;
  for (const Command* command : commands) {
    if (hidden_too || !command->hidden) {
      names.emplace_back(command->name);
    }
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

/// What is wrong with the command line, with the nearest known name.
std::string usage_error(const CLI::App& options, const CLI::ParseError& error) {
  for (const std::string& word : options.remaining(true)) {
    if (word.starts_with("-")) {
      const std::string name = word.substr(0, word.find('='));
      return fmt::format("unknown option {}{}", name, suggestion(name, option_names(options)));
    }
    return fmt::format("unexpected argument \"{}\"", word);
  }
  return error.what();
}

/// Every command's options and what carries it out.
struct Parser {
  CLI::App app{"fexp: explicit dynamics of thin shells with contact"};
  std::vector<std::pair<CLI::App*, std::function<ExitCode()>>> actions;

  Parser() {
    app.name("fexp");
    app.set_version_flag("--version", "fexp " FEXP_VERSION);
    app.footer(overview_footer());
    app.require_subcommand(1);
    for (const Command* command : commands) {
      CLI::App* options = app.add_subcommand(command->name, command->purpose);
      options->footer(fmt::format("\nExamples:\n{}\n\n{}", command->examples, exit_code_text()));
      if (command->hidden) {
        options->group("");
      }
      actions.emplace_back(options, command->declare(*options));
    }
  }

  /// The innermost command on the command line.
  [[nodiscard]] const CLI::App& chosen() const {
    const CLI::App* command = &app;
    for (auto given = command->get_subcommands(); !given.empty(); given = command->get_subcommands()) {
      command = given.front();
    }
    return *command;
  }
};

/// "fexp cluster add"
std::string full_name(const CLI::App& command) {
  return command.get_parent() == nullptr ? command.get_name()
                                         : full_name(*command.get_parent()) + " " + command.get_name();
}

ExitCode parse_and_run(int argc, const char* const* argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const std::vector<std::string> names = command_names(true);
  if (!first.empty() && !first.starts_with("-") && std::ranges::find(names, first) == names.end()) {
    complain(fmt::format("unknown command \"{}\"{}\nCommands: {}. \"fexp --help\" tells more.", first,
                         suggestion(first, command_names(false)), fmt::join(command_names(false), ", ")));
    return ExitCode::wrong_input;
  }
  Parser parser;
  try {
    parser.app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    parser.app.exit(success);
    return ExitCode::done;
  } catch (const CLI::ParseError& error) {
    const CLI::App& options = parser.chosen();
    complain(fmt::format("{}\n\"{} --help\" tells what is known.", usage_error(options, error), full_name(options)));
    return ExitCode::wrong_input;
  }
  const auto is_chosen = [](const auto& action) { return action.first->parsed(); };
  return std::ranges::find_if(parser.actions, is_chosen)->second();
}

ExitCode run_guarded(int argc, const char* const* argv) noexcept {
  try {
    return parse_and_run(argc, argv);
  } catch (const InputErrors& errors) {
    for (const InputError& error : errors.errors()) {
      complain(error.text());
    }
    return ExitCode::wrong_input;
  } catch (const io::OutputError& error) {
    complain(error.what());
    return ExitCode::output;
  } catch (const std::bad_alloc&) {
    print_error("fexp: out of memory; cure: take a coarser mesh, fewer bodies or a machine with more memory\n");
  } catch (const std::exception& error) {
    complain(fmt::format("an error of fexp itself: {}; cure: report it with the deck", error.what()));
  }
  return ExitCode::internal;
}

}  // namespace

int run_command_line(int argc, const char* const* argv) noexcept {
  ExitCode code = run_guarded(argc, argv);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    print_error("fexp: cannot write to the standard output; cure: free some space or direct it elsewhere\n");
    code = code == ExitCode::done ? ExitCode::output : code;
  }
  return static_cast<int>(code);
}

}  // namespace fexp::app
