// SPDX-License-Identifier: Apache-2.0
#include "app/options.hpp"

namespace fexp::app {

void add_deck_option(CLI::App& options, std::string& deck) {
  options.add_option("DECK", deck, "Deck (TOML) that describes the run; \"fexp reference\" tells what may stand in it")
      ->required();
}

void add_threads_option(CLI::App& options, int& threads) {
  constexpr int most = 4096;
  options.add_option("--threads", threads, "Threads to compute with; as many as the machine has when left out")
      ->check(CLI::Range(1, most))
      ->option_text("N");
}

void add_json_option(CLI::App& options, bool& json, const char* meaning) { options.add_flag("--json", json, meaning); }

}  // namespace fexp::app
