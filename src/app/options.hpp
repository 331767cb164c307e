// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace fexp::app {

/// Options that several commands share.

/// A deck as the first argument.
void add_deck_option(CLI::App& options, std::string& deck);
void add_threads_option(CLI::App& options, int& threads);
void add_json_option(CLI::App& options, bool& json, const char* meaning);

}  // namespace fexp::app
