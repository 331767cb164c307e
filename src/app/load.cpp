// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include "app/penetrations.hpp"
#include "app/schedule.hpp"
#include "base/errors.hpp"
#include "io/output_error.hpp"
#include "model/build.hpp"
#include "model/build_checks.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

std::string read_deck(const fs::path& path, io::InputFiles& files) {
  ErrorList errors;
  std::string text;
  if (files.kind(path) == io::InputFiles::Kind::directory) {
    errors.add({path.string()}, "cannot read: it is a directory", "a readable deck (TOML)", "name the deck in it");
  } else {
    try {
      text = files.read(path);
    } catch (const io::OutputError& failure) {
      errors.add({path.string()}, failure.message(), "a readable deck (TOML)", "check the path");
    }
  }
  errors.throw_if_any();
  return text;
}

}  // namespace

Case load_case(const fs::path& deck) {
  io::InputFiles files;
  return load_case(deck, files);
}

Case load_case(const fs::path& deck, io::InputFiles& files) {
  std::vector<model::Mesh> meshes;
  return load_case(deck, files, meshes);
}

Case load_case(const fs::path& deck, std::vector<model::Mesh>& meshes) {
  io::InputFiles files;
  return load_case(deck, files, meshes);
}

Case load_case(const fs::path& deck, io::InputFiles& files, std::vector<model::Mesh>& meshes) {
  Case loaded;
  loaded.deck_bytes = read_deck(deck, files);
  ErrorList errors;
  loaded.deck = io::parse_deck(loaded.deck_bytes, deck.string(), errors);
  errors.throw_if_any();
  check_intervals(loaded.deck, errors);
  meshes = io::load_meshes(loaded.deck, deck.parent_path(), files, errors);
  if (!errors.empty()) {
    // Without all meshes no model; what can be said without them is said.
    model::check_description(loaded.deck.description, errors);
    errors.throw_if_any();
  }
  loaded.model = model::build_model(loaded.deck.description, meshes, errors);
  errors.throw_if_any();
  treat_penetrations(meshes, loaded, errors);
  errors.throw_if_any();
  io::check_output(loaded.deck.output, loaded.model, errors);
  errors.throw_if_any();
  fill_intervals(loaded.model.first_step(), loaded.deck);
  return loaded;
}

}  // namespace fexp::app
