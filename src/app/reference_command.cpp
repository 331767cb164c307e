// SPDX-License-Identifier: Apache-2.0
#include "app/command.hpp"
#include "app/print.hpp"
#include "io/deck.hpp"

namespace fexp::app {

namespace {

std::function<ExitCode()> declare_reference(CLI::App&) {
  return [] {
    print_out(io::deck_reference());
    return ExitCode::done;
  };
}

}  // namespace

const Command reference_command{"reference", "Print the reference of the deck (Markdown)", "  fexp reference | less",
                                declare_reference};

}  // namespace fexp::app
