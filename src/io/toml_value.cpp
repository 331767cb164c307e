// SPDX-License-Identifier: Apache-2.0
#include "io/toml_value.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>

#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

constexpr std::string_view toml_rules = "TOML 1.0 (toml.io)";

TomlValue converted(const toml::node& node) {
  TomlValue result{false, static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column)};
  node.visit([&result](const auto& typed) {
    using Node = std::decay_t<decltype(typed)>;
    if constexpr (std::is_same_v<Node, toml::table>) {
      TomlTable table;
      for (const auto& [key, value] : typed) {
        const toml::source_position& begin = key.source().begin;
        table.push_back(
            {std::string(key.str()), static_cast<int>(begin.line), static_cast<int>(begin.column), converted(value)});
      }
      result.value = std::move(table);
    } else if constexpr (std::is_same_v<Node, toml::array>) {
      TomlArray array;
      for (const toml::node& value : typed) {
        array.push_back(converted(value));
      }
      result.value = std::move(array);
    } else if constexpr (toml::is_date<Node> || toml::is_time<Node> || toml::is_date_time<Node>) {
      result.value = TomlDate{};
    } else {
      result.value = typed.get();
    }
  });
  return result;
}

/// Whether a dotted key has more parts than anyone writes: toml++ and the conversion call themselves once for each.
/// Where it has, `line` and `column` say where.
bool is_too_deep(std::string_view text, int& line, int& column) {
  constexpr int most_dots = 256;
  int dots = 0;
  line = 1;
  column = 0;
  for (const char c : text) {
    ++column;
    if (c == '\n') {
      ++line;
      column = 0;
    }
    dots = c == '.' ? dots + 1 : c == '\n' || c == ',' || c == '=' || c == '#' ? 0 : dots;
    if (dots > most_dots) {
      return true;
    }
  }
  return false;
}

void add_syntax_error(const toml::parse_error& error, const std::string& file, ErrorList& errors) {
  const toml::source_position& begin = error.source().begin;
  const std::string_view description = error.description();
  std::string cure = "correct the deck at this place";
  if (description.find("redefine") != std::string_view::npos) {
    cure = "give each key and each [table] once; things of which there can be several are [[tables]]";
  } else if (description.find("utf-8") != std::string_view::npos ||
             description.find("overlong") != std::string_view::npos) {
    cure = "save the deck as UTF-8 text";
  } else if (description.find("parsing string") != std::string_view::npos) {
    cure = "end the text with a quote in the same line, and write \\\\ for a backslash in double quotes";
  } else if (description.find("could not be interpreted") != std::string_view::npos ||
             description.find("not representable") != std::string_view::npos) {
    cure = "write a number that is 0 or from 1e-100 to 1e100 in size";
  }
  std::string message;
  for (const char c : description) {  // toml++ quotes what it met, which may be any character
    message += c >= ' ' && c <= '~' ? c : '?';
  }
  errors.add({file, static_cast<int>(begin.line), static_cast<int>(begin.column)}, "this is no TOML: " + message,
             std::string(toml_rules), cure);
}

}  // namespace

std::optional<TomlValue> read_toml(std::string_view text, const std::string& file, ErrorList& errors) {
  int line = 0, column = 0;
  if (is_too_deep(text, line, column)) {
    errors.add({file, line, column}, "tables are nested too deep", "at most 256 parts in a dotted key",
               "correct the key");
    return std::nullopt;
  }
  try {
    return converted(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    add_syntax_error(error, file, errors);
    return std::nullopt;
  }
}

const TomlEntry* find_entry(const TomlTable& table, std::string_view key) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const TomlEntry& entry) { return entry.key == key; });
  return found == table.end() ? nullptr : &*found;
}

std::string found_text(const TomlValue& value) {
  struct Text {
    std::string operator()(bool found) const { return found ? "true" : "false"; }
    std::string operator()(std::int64_t found) const { return fmt::format("the whole number {}", found); }
    std::string operator()(double found) const { return fmt::format("the number {:#}", found); }
    std::string operator()(const std::string& found) const { return fmt::format("the text \"{}\"", shown(found)); }
    std::string operator()(const TomlDate&) const { return "a date or time"; }
    std::string operator()(const TomlArray& found) const {
      return found.empty() ? "an empty list"
                           : fmt::format("a list of {} value{}", found.size(), found.size() == 1 ? "" : "s");
    }
    std::string operator()(const TomlTable&) const { return "a table"; }
  };
  return std::visit(Text{}, value.value);
}

}  // namespace fexp::io
