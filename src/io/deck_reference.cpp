// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/deck.hpp"
#include "io/deck_sections.hpp"
#include "io/field_text.hpp"

namespace fexp::io {

namespace {

constexpr std::string_view introduction = R"(# The deck

A run is described by one TOML file ([toml.io](https://toml.io)), the deck. `fexp check DECK` says whether it makes sense, `fexp run DECK` runs it. This page is made from the program's own definitions by `fexp reference > docs/deck.md`.

- The solver is free of units: use any consistent set. `[units]` only names them. The column *unit* below gives dimensions.
- A number may be written whole (`2`) or real (`2.0`), but what counts (cells, copies) must be whole. Numbers are 0 or from 1e-100 to 1e100 in size. A vector is a list of three numbers, `[x, y, z]`.
- Tables of which there can be several have double brackets, `[[body]]`. A table inside another one can be written in braces, `mesh = { kind = "plate", length_x = 1, length_y = 1 }`, or below it under a header of its own, `[body.mesh]`.
- Sections, materials, curves, node sets and bodies are referred to by name. The order of the tables does not matter, except that rotations are applied as listed.
- Unknown keys, wrong types, values out of range and names that are not there are errors with line and column; all of them are shown at once, and nothing is run.
)";

constexpr std::string_view example = R"(title = "A ball falls on a clamped plate"

[units]
length = "m"
time = "s"
mass = "kg"
force = "N"

[run]
duration = 0.01

[[material]]
name = "rubber"
density = 1100.0
young = 5.0e6
poisson = 0.45

[[section]]
name = "skin"
material = "rubber"
thickness = 0.005

[[body]]
name = "ball"
mesh = { kind = "cubed_sphere", radius = 0.1, cells = 4 }
section = "skin"
translate = [0.0, 0.0, 0.11]
velocity = [0.0, 0.0, -2.0]

[[body]]
name = "plate"
section = "skin"
translate = [-0.2, -0.2, 0.0]
[body.mesh]
kind = "plate"
length_x = 0.4
length_y = 0.4
cells_x = 8
cells_y = 8

[[node_set]]
name = "rim"
bodies = ["plate"]
boundary = true

[[fixed]]
set = "rim"

[[curve]]
name = "ramp"
points = [[0.0, 0.0], [0.005, 1.0]]

[[gravity]]
acceleration = [0.0, 0.0, -9.81]

[[pressure]]
bodies = ["ball"]
value = -100.0
curve = "ramp"

[[plane]]
name = "floor"
point = [0.0, 0.0, -0.3]
normal = [0.0, 0.0, 1.0]

[output]
results_interval = 5.0e-4
nodes = ["rim"]
bodies = ["ball"]
)";

/// Defaults as TOML; nothing for what is absent unless given.
std::string default_text(bool value, const Limits&) { return value ? "true" : "false"; }
std::string default_text(int value, const Limits&) { return fmt::format("{}", value); }
std::string default_text(double value, const Limits& limits) {
  // A default outside the accepted range stands for "left out"; the meaning says what happens then.
  return limits.range.contains(value) ? fmt::format("{}", value) : "";
}
std::string default_text(const std::string& value, const Limits&) {
  return value.empty() ? "" : fmt::format("\"{}\"", value);
}
std::string default_text(const Vec3d& value, const Limits&) {
  return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
}
std::string default_text(const std::vector<std::string>& value, const Limits&) {
  return value.empty() ? "" : fmt::format("[\"{}\"]", fmt::join(value, "\", \""));
}
template <class Other>
std::string default_text(const Other&, const Limits&) {
  return "";
}

std::string accepted_text(const Limits& limits) {
  if (!limits.choices.empty()) {
    return fmt::format("`{}`", fmt::join(limits.choices, "`, `"));
  }
  return limits.range.text == any_number.text ? "" : std::string(limits.range.text);
}

/// A row per field: key, type, unit, default, accepted, meaning.
class FieldTable {
 public:
  explicit FieldTable(std::string& text) : text_(text) {
    text_ += "\n| key | type | unit | default | accepted | meaning |\n|---|---|---|---|---|---|\n";
  }
  void row(std::string_view key, std::string_view type, std::string_view unit, std::string_view default_value,
           std::string_view accepted, std::string_view meaning) {
    text_ += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key, type, unit, default_value, accepted, meaning);
  }
  template <HasFields Struct>
  void rows() {
    const Struct defaults{};
    for_each_field<Struct>([&](const auto& field) {
      const auto& value = defaults.*field.member;
      const Limits limits{field.range, field.choices};
      const std::string text = default_text(value, limits);
      const std::string shown_default = field.presence == Presence::required ? "**required**"
                                        : text.empty()                       ? ""
                                                                             : fmt::format("`{}`", text);
      row(field.name, type_text(value, {}), field.unit, shown_default, accepted_text(limits), field.meaning);
    });
  }

 private:
  std::string& text_;
};

/// Writes a chapter for every section of the deck, with the tables inside it below.
class ReferenceWriter {
 public:
  explicit ReferenceWriter(std::string& text) : text_(text) {}

  template <class Struct>
  void table(const std::string& name, std::string_view meaning, Presence presence, const Struct&) {
    chapter(fmt::format("[{}]", name), meaning, presence);
    structure<Struct>(name);
  }
  template <class Struct>
  void list(const std::string& name, std::string_view meaning, Presence presence, const std::vector<Struct>&) {
    chapter(fmt::format("[[{}]]", name), meaning, presence);
    if constexpr (std::is_same_v<Struct, model::Material>) {
      FieldTable rows(text_);
      rows.rows<Struct>();
      rows.row("law", "a text", "-", fmt::format("`\"{}\"`", kinds<physics::AnyMaterial>().front()), "see below",
               "The law, whose parameters stand in the same table.");
      alternatives<physics::AnyMaterial>(name, "law");
    } else {
      structure<Struct>(name);
    }
  }

 private:
  void chapter(const std::string& header, std::string_view meaning, Presence presence) {
    text_ += fmt::format("\n## `{}`\n\n{}{}\n", header, meaning,
                         presence == Presence::required ? " Every deck has it." : "");
  }

  template <HasFields Struct>
  void structure(const std::string& path) {
    FieldTable(text_).rows<Struct>();
    for_each_field<Struct>([&](const auto& field) {
      inner<typename std::decay_t<decltype(field)>::ValueType>(fmt::format("{}.{}", path, field.name), field.meaning);
    });
  }

  /// The table that a field holds, if it holds one.
  template <class Value>
  void inner(const std::string& path, std::string_view meaning) {
    if constexpr (IsVariant<Value>::value) {
      text_ += fmt::format("\n### `{}`\n\n{} Its `kind` (**required**) is one of `{}`.\n", path, meaning,
                           fmt::join(kinds<Value>(), "`, `"));
      alternatives<Value>(path, "kind");
    } else if constexpr (HasFields<Value>) {
      text_ += fmt::format("\n### `{}`\n\n{}\n", path, meaning);
      structure<Value>(path);
    } else if constexpr (requires { requires HasFields<typename Value::value_type>; }) {
      inner<typename Value::value_type>(path, meaning);
    }
  }

  template <class Variant>
  void alternatives(const std::string& path, std::string_view selector) {
    for_each_alternative<Variant>([&]<class Alternative>(const Alternative&) {
      text_ += fmt::format("\n#### `{}` with `{} = \"{}\"`\n", path, selector, Alternative::kind);
      FieldTable(text_).rows<Alternative>();
    });
    // The tables inside them once each, as several may have the same.
    std::set<std::string> written;
    for_each_alternative<Variant>([&]<class Alternative>(const Alternative&) {
      for_each_field<Alternative>([&](const auto& field) {
        const std::string inside = fmt::format("{}.{}", path, field.name);
        if (written.insert(inside).second) {
          inner<typename std::decay_t<decltype(field)>::ValueType>(inside, field.meaning);
        }
      });
    });
  }

  std::string& text_;
};

}  // namespace

std::string deck_reference() {
  std::string text(introduction);
  text += "\n## Example\n\n```toml\n";
  text += example;
  text += "```\n\n## Before the first section\n";
  FieldTable(text).row("title", "a text", "-", "", "", "A line that describes the run.");
  ReferenceWriter writer(text);
  const Deck deck;
  for_each_section(deck, writer);
  return text;
}

}  // namespace fexp::io
