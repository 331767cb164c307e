// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include "app/schedule.hpp"
#include "base/errors.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "model/build.hpp"
#include "model/build_checks.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

std::string read_deck(const fs::path& path) {
  ErrorList errors;
  std::error_code error;
  std::string text;
  if (fs::is_directory(path, error)) {
    errors.add({path.string()}, "cannot read: it is a directory", "a readable deck (TOML)", "name the deck in it");
  } else {
    try {
      text = io::read_whole(path);
    } catch (const io::OutputError& failure) {
      errors.add({path.string()}, failure.message(), "a readable deck (TOML)", "check the path");
    }
  }
  errors.throw_if_any();
  return text;
}

}  // namespace

Case load_case(const fs::path& path) {
  Case loaded;
  loaded.deck_bytes = read_deck(path);
  ErrorList errors;
  loaded.deck = io::parse_deck(loaded.deck_bytes, path.string(), errors);
  errors.throw_if_any();
  check_intervals(loaded.deck, errors);
  const std::vector<model::Mesh> meshes = io::load_meshes(loaded.deck, path.parent_path(), errors);
  if (!errors.empty()) {
    // Without all meshes no model; what can be said without them is said.
    model::check_description(loaded.deck.description, errors);
    errors.throw_if_any();
  }
  loaded.model = model::build_model(loaded.deck.description, meshes, errors);
  errors.throw_if_any();
  io::check_output(loaded.deck.output, loaded.model, errors);
  errors.throw_if_any();
  fill_intervals(loaded.model.run.safety * loaded.model.first_critical_step, loaded.deck);
  return loaded;
}

}  // namespace fexp::app
