// SPDX-License-Identifier: Apache-2.0
#include "io/deck.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/deck_sections.hpp"
#include "io/toml_fields.hpp"
#include "model/build_checks.hpp"
#include "model/node_sets.hpp"

namespace fexp::io {

namespace {

/// Reads the sections of a deck from its root table.
class SectionReader {
 public:
  SectionReader(const TomlTable& root, FieldReader& fields) : root_(root), fields_(fields) {}

  template <class Struct>
  void table(const std::string& name, std::string_view meaning, Presence presence, Struct& out) {
    if (const TomlValue* value = section(name, fmt::format("[{}]", name), meaning, presence)) {
      fields_.table(*value, name, out);
    }
  }

  template <class Struct>
  void list(const std::string& name, std::string_view meaning, Presence presence, std::vector<Struct>& out) {
    const TomlValue* value = section(name, fmt::format("[[{}]]", name), meaning, presence);
    const TomlArray* items = value == nullptr ? nullptr : fields_.as_list_of_tables(*value, name);
    if (items == nullptr) {
      complete_ = complete_ && value == nullptr;
      return;
    }
    if (items->empty() && presence == Presence::required) {
      missing(value->line, value->column, fmt::format("[[{}]]", name), meaning);
    }
    out.reserve(items->size());
    for (const TomlValue& item : *items) {
      read_item(item, name, out.emplace_back());
    }
  }

  /// Reports keys of the root that are neither sections nor `others`.
  void check_keys(std::vector<std::string> others) {
    names_.insert(names_.begin(), others.begin(), others.end());
    fields_.noting_faults({{}, 0, 0}, [&] { fields_.check_keys(root_, "", names_); });
    complete_ = complete_ && !fields_.is_faulty({{}, 0, 0});
  }

  /// Whether every section was found where it belongs.
  [[nodiscard]] bool complete() const noexcept { return complete_; }

 private:
  const TomlValue* section(const std::string& name, const std::string& header, std::string_view meaning,
                           Presence presence) {
    names_.push_back(name);
    if (const TomlEntry* entry = find_entry(root_, name)) {
      return &entry->value;
    }
    if (presence == Presence::required) {
      missing(1, 1, header, meaning);
    }
    return nullptr;
  }

  void missing(int line, int column, const std::string& header, std::string_view meaning) {
    complete_ = false;
    fields_.add(line, column, fmt::format("the deck has no {}", header), header + " at least once",
                fmt::format("add {}: {}", header, meaning));
  }

  template <class Struct>
  void read_item(const TomlValue& item, const std::string& path, Struct& out) {
    fields_.table(item, path, out);
  }
  /// A material's parameters stand beside its name.
  void read_item(const TomlValue& item, const std::string& path, model::Material& out) {
    out.place = fields_.place(item);
    fields_.noting_faults(item, [&] {
      if (const TomlTable* entries = fields_.as_table(item, path)) {
        fields_.members(item, *entries, path, out);
        fields_.alternative(item, path, "law", Presence::optional, out.law, field_names<model::Material>());
      }
    });
  }
  void read_item(const TomlValue& item, const std::string& path, model::BodyDescription& out) {
    fields_.table(item, path, out);
    const auto* entries = std::get_if<TomlTable>(&item.value);
    const TomlEntry* mesh = entries == nullptr ? nullptr : find_entry(*entries, "mesh");
    out.mesh_place = mesh == nullptr ? out.place : fields_.place(mesh->value);
  }

  const TomlTable& root_;
  FieldReader& fields_;
  std::vector<std::string> names_;
  bool complete_{true};
};

template <class Named>
bool all_named(const std::vector<Named>& items) {
  return std::none_of(items.begin(), items.end(), [](const Named& item) { return item.name.empty(); });
}

/// No model is built from a deck with errors, so what is wrong between its tables is told at once, too: of tables that
/// could be read, when all that they may refer to is known by name.
void add_reference_errors(const model::Description& d, const FieldReader& fields, ErrorList& errors) {
  if (fields.is_full() || !all_named(d.curves) || !all_named(d.materials) || !all_named(d.sections) ||
      !all_named(d.bodies) || !all_named(d.node_sets)) {
    return;
  }
  ErrorList found;
  model::check_description(d, found);
  for (const InputError& error : found.errors()) {
    if (!fields.is_faulty(error.place)) {
      errors.add(error);
    }
  }
}

bool stands_before(const InputError& a, const InputError& b) {
  return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
}

}  // namespace

Deck parse_deck(std::string_view text, const std::string& file, ErrorList& errors) {
  Deck deck;
  ErrorList found;
  if (const std::optional<TomlValue> root = read_toml(text, file, found)) {
    const auto& table = std::get<TomlTable>(root->value);
    FieldReader fields(file, found);
    SectionReader sections(table, fields);
    if (const TomlEntry* title = find_entry(table, "title")) {
      fields.read(title->value, "title", {}, deck.title);
    }
    for_each_section(deck, sections);
    sections.check_keys({"title"});
    check_expectations(deck.verify, deck.expectations, found);
    refine_meshes(deck.refinement, deck.description.bodies, found);
    if (!found.empty() && sections.complete()) {
      add_reference_errors(deck.description, fields, found);
    }
  }
  const bool more = found.size() >= FieldReader::most_errors;
  std::vector<InputError> sorted = found.errors();
  std::stable_sort(sorted.begin(), sorted.end(), stands_before);
  for (InputError& error : sorted) {
    errors.add(std::move(error));
  }
  if (more) {
    errors.add({file, 0, 0}, "there may be more errors", fmt::format("{} are shown", FieldReader::most_errors),
               "correct these first");
  }
  return deck;
}

void check_output(const OutputSettings& output, const model::Model& model, ErrorList& errors) {
  std::vector<std::string> sets;
  for (const model::NamedNodes& set : model.node_sets) {
    sets.push_back(set.name);
  }
  const auto check = [&](const char* key, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (std::find(sets.begin(), sets.end(), name) == sets.end()) {
        errors.add(output.place, fmt::format("output.{} names node set \"{}\", which is not there", key, name),
                   model::name_list(sets), "define it or correct the name");
      }
    }
  };
  check("nodes", output.nodes);
  check("elements", output.elements);
  static_cast<void>(model::BodyNames(model).find(output.bodies, output.place, "output.bodies", errors));
}

}  // namespace fexp::io
