// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "app/run_driver.hpp"

namespace fexp::app {

/// Options that several commands share.

/// A deck as the first argument.
void add_deck_option(CLI::App& options, std::string& deck);
void add_threads_option(CLI::App& options, int& threads);
void add_json_option(CLI::App& options, bool& json, const char* meaning);

/// Wall time between checkpoints on the disk [s].
void add_checkpoint_option(CLI::App& options, double& seconds);

/// An option whose value is one of a few names.
template <class Value>
CLI::Option* add_choice(CLI::App& options, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& meaning) {
  return options.add_option_function<std::string>(
      name,
      [&value, choices, name](const std::string& text) {
        const auto found = choices.find(text);
        if (found == choices.end()) {
          std::string names;
          for (const auto& [choice, ignored] : choices) {
            names += (names.empty() ? "" : ", ") + choice;
          }
          throw CLI::ValidationError(name, "\"" + text + "\" is not known; accepted: " + names);
        }
        value = found->second;
      },
      meaning);
}

/// Where islands go on several machines.
void add_placement_option(CLI::App& options, cluster::PlacementRule& rule);
/// The rules by the names that the option knows them by.
[[nodiscard]] const std::map<std::string, cluster::PlacementRule>& placement_rules();
/// How often to save, and where islands go on several machines.
void add_drive_options(CLI::App& options, DriveSettings& settings);

}  // namespace fexp::app
