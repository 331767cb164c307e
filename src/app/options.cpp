// SPDX-License-Identifier: Apache-2.0
#include "app/options.hpp"

#include <map>
#include <string>

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

void add_checkpoint_option(CLI::App& options, double& seconds) {
  constexpr double longest = 1.0e9;
  options
      .add_option("--checkpoint-every", seconds,
                  "Wall time between checkpoints, from which \"fexp resume\" goes on; 60 when left out, and more where "
                  "they would cost more than 2 % of the time")
      ->check(CLI::Range(0.0, longest))
      ->option_text("SECONDS");
}

const std::map<std::string, cluster::PlacementRule>& placement_rules() {
  static const std::map<std::string, cluster::PlacementRule> rules{
      {"elements", cluster::PlacementRule::fewest_elements}, {"cost", cluster::PlacementRule::measured_cost}};
  return rules;
}

void add_placement_option(CLI::App& options, cluster::PlacementRule& rule) {
  add_choice(options, "--placement", rule, placement_rules(),
             "Where islands go on several machines: elements (to the machine with the fewest, when islands merge or "
             "split), or cost (by measured cost and speed); the results are the same")
      ->option_text("RULE");
}

void add_drive_options(CLI::App& options, DriveSettings& settings) {
  add_checkpoint_option(options, settings.checkpoint_seconds);
  add_placement_option(options, settings.world.rule);
  options
      .add_option("--latency", settings.world.latency_seconds,
                  "Time added to every message between machines, to see what a slow network does")
      ->check(CLI::Range(0.0, 10.0))
      ->option_text("SECONDS");
}

}  // namespace fexp::app
