// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/schedule.hpp"
#include "base/errors.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "io/similar_names.hpp"
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
    errors.add({path.string()}, "cannot read the deck: it is a directory", "a TOML file", "name the deck in it");
  } else {
    try {
      text = io::read_whole(path);
    } catch (const io::OutputError& failure) {
      errors.add({path.string()}, "cannot read the deck: " + failure.message(), "a readable TOML file",
                 "check the path");
    }
  }
  errors.throw_if_any();
  return text;
}

/// Reports names chosen for histories that the model does not have.
void check_choice(const std::string& field, const std::string& what, const std::vector<std::string>& chosen,
                  const std::vector<std::string>& known, const Place& place, ErrorList& errors) {
  for (const std::string& name : chosen) {
    if (std::ranges::find(known, name) == known.end()) {
      const std::vector<std::string> similar = io::similar_names(name, known);
      errors.add(place, fmt::format("output.{} names {} \"{}\", which is not there", field, what, name),
                 model::name_list(known),
                 similar.empty() ? fmt::format("correct the name or add the {}", what)
                                 : fmt::format("did you mean \"{}\"?", similar.front()));
    }
  }
}

void check_choices(const Case& loaded, const Place& place, ErrorList& errors) {
  std::vector<std::string> sets;
  for (const model::NamedNodes& set : loaded.model.node_sets) {
    sets.push_back(set.name);
  }
  check_choice("nodes", "node set", loaded.deck.output.nodes, sets, place, errors);
  std::vector<std::string> bodies;
  for (const model::Body& body : loaded.model.bodies) {
    if (bodies.empty() || bodies.back() != body.family) {
      bodies.push_back(body.family);
    }
  }
  for (const model::Body& body : loaded.model.bodies) {
    if (body.name != body.family) {
      bodies.push_back(body.name);
    }
  }
  check_choice("bodies", "body", loaded.deck.output.bodies, bodies, place, errors);
}

}  // namespace

Case load_case(const fs::path& path) {
  Case loaded;
  loaded.deck_bytes = read_deck(path);
  ErrorList errors;
  loaded.deck = io::parse_deck(loaded.deck_bytes, path.string(), errors);
  errors.throw_if_any();
  const Place place{path.string()};
  fill_intervals(loaded.deck, place, errors);
  const std::vector<model::Mesh> meshes = io::load_meshes(loaded.deck, path.parent_path(), errors);
  if (!errors.empty()) {
    // Without all meshes no model; what can be said without them is said.
    model::check_description(loaded.deck.description, errors);
    errors.throw_if_any();
  }
  loaded.model = model::build_model(loaded.deck.description, meshes, errors);
  errors.throw_if_any();
  check_choices(loaded, place, errors);
  errors.throw_if_any();
  return loaded;
}

}  // namespace fexp::app
