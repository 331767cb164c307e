// SPDX-License-Identifier: Apache-2.0
#include "io/toml_fields.hpp"

#include <algorithm>
#include <cmath>

#include "io/similar_names.hpp"
#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

/// What to do about a value of the wrong type, from what was written.
std::string type_cure(const TomlValue& value, const std::string& accepted) {
  const bool wants_number = accepted.find("number") != std::string::npos;
  if (std::holds_alternative<std::string>(value.value) && (wants_number || accepted == "true or false")) {
    return "write it without quotes";
  }
  if (std::holds_alternative<double>(value.value) && accepted.find("whole number") == 2) {
    return "write it without a decimal point";
  }
  if (accepted.find("list of tables") != std::string::npos) {
    return "write the table's header with double brackets, [[...]]";
  }
  return "write " + accepted;
}

std::string did_you_mean(std::string_view wanted, std::span<const std::string> known, std::string_view otherwise) {
  constexpr std::size_t most_letters = 100;  // Nobody misspells more.
  const std::vector<std::string> similar =
      wanted.size() > most_letters ? std::vector<std::string>{} : similar_names(wanted, known);
  return similar.empty() ? std::string(otherwise) : fmt::format("did you mean \"{}\"?", fmt::join(similar, "\" or \""));
}

}  // namespace

std::string one_of(Choices choices) { return fmt::format("one of {}", fmt::join(choices, ", ")); }

void FieldReader::add(int line, int column, std::string message, std::string accepted, std::string cure) {
  if (!is_full()) {
    errors_.add({file_, line, column}, std::move(message), std::move(accepted), std::move(cure));
  }
}

void FieldReader::wrong_type(const TomlValue& value, const std::string& path, const std::string& accepted) {
  add(value.line, value.column, fmt::format("{} is {}", path, found_text(value)), accepted, type_cure(value, accepted));
}

void FieldReader::missing_key(const TomlValue& table, const std::string& path, std::string_view key,
                              const std::string& accepted, std::string_view meaning) {
  add(table.line, table.column, fmt::format("{} lacks \"{}\"", path, key), accepted,
      fmt::format("add {} = ... ({})", key, meaning.substr(0, meaning.find_last_not_of('.') + 1)));
}

const TomlTable* FieldReader::as_table(const TomlValue& value, const std::string& path) {
  const auto* table = std::get_if<TomlTable>(&value.value);
  if (table == nullptr) {
    const auto* list = std::get_if<TomlArray>(&value.value);
    const bool header = list != nullptr && !list->empty() && std::holds_alternative<TomlTable>(list->front().value);
    add(value.line, value.column, fmt::format("{} is {}", path, found_text(value)), "a table",
        header ? fmt::format("give it once, with single brackets, [{}]", path)
               : "write a table, { key = value, ... }, or give it a header of its own");
  }
  return table;
}

const TomlArray* FieldReader::as_list_of_tables(const TomlValue& value, const std::string& path) {
  const auto* list = std::get_if<TomlArray>(&value.value);
  if (list == nullptr) {
    add(value.line, value.column, fmt::format("{} is {}", path, found_text(value)), "a list of tables",
        fmt::format("write the header of each with double brackets, [[{}]]", path));
  }
  return list;
}

void FieldReader::check_keys(const TomlTable& table, const std::string& path, std::span<const std::string> known) {
  for (const TomlEntry& entry : table) {
    if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
      add(entry.line, entry.column,
          path.empty() ? fmt::format("unknown section or key \"{}\"", shown(entry.key))
                       : fmt::format("unknown key \"{}\" in {}", shown(entry.key), path),
          fmt::format("{}", fmt::join(known, ", ")), did_you_mean(entry.key, known, "use one of these, or remove it"));
    }
  }
}

std::string FieldReader::chosen_kind(const TomlValue& table, const std::string& path, std::string_view selector,
                                     Presence presence, const std::vector<std::string>& kinds) {
  const std::string accepted = fmt::format("one of {}", fmt::join(kinds, ", "));
  const auto* entries = as_table(table, path);
  if (entries == nullptr) {
    return {};
  }
  const TomlEntry* entry = find_entry(*entries, selector);
  if (entry == nullptr) {
    if (presence == Presence::optional) {
      return kinds.front();
    }
    missing_key(table, path, selector, accepted, "the parameters follow from it");
    return {};
  }
  const auto* kind = std::get_if<std::string>(&entry->value.value);
  if (kind == nullptr || std::find(kinds.begin(), kinds.end(), *kind) == kinds.end()) {
    add(entry->value.line, entry->value.column, fmt::format("{}.{} is {}", path, selector, found_text(entry->value)),
        accepted, kind == nullptr ? "write the name in quotes" : did_you_mean(*kind, kinds, "use one of these"));
    return {};
  }
  return *kind;
}

void FieldReader::read(const TomlValue& value, const std::string& path, const Limits& limits, bool& out) {
  if (const auto* found = std::get_if<bool>(&value.value)) {
    out = *found;
  } else {
    wrong_type(value, path, type_text(out, limits));
  }
}

void FieldReader::read(const TomlValue& value, const std::string& path, const Limits& limits, int& out) {
  const auto* found = std::get_if<std::int64_t>(&value.value);
  if (found == nullptr) {
    wrong_type(value, path, type_text(out, limits));
    return;
  }
  const bool fits = *found >= std::numeric_limits<int>::min() && *found <= std::numeric_limits<int>::max();
  if (!fits || !limits.range.contains(static_cast<double>(*found))) {
    add(value.line, value.column, fmt::format("{} is {}", path, *found), type_text(out, limits), "correct the number");
    return;
  }
  out = static_cast<int>(*found);
}

void FieldReader::read(const TomlValue& value, const std::string& path, const Limits& limits, double& out) {
  const auto* whole = std::get_if<std::int64_t>(&value.value);
  const auto* real = std::get_if<double>(&value.value);
  if (whole == nullptr && real == nullptr) {
    wrong_type(value, path, type_text(out, limits));
    return;
  }
  const double number = real != nullptr ? *real : static_cast<double>(*whole);
  if (!limits.range.contains(number)) {
    add(value.line, value.column, fmt::format("{} is {}", path, number),
        std::isfinite(number) ? type_text(out, limits) : "a finite number" + in_words(limits.range),
        "correct the number");
  } else if (number != 0.0 && (std::abs(number) > largest_number || std::abs(number) < smallest_number)) {
    add(value.line, value.column, fmt::format("{} is {}", path, number),
        fmt::format("{}a number from {} to {} in size", limits.range.contains(0.0) ? "0, or " : "", smallest_number,
                    largest_number),
        "correct the number, or choose other units");
  } else {
    out = number;
  }
}

void FieldReader::read(const TomlValue& value, const std::string& path, const Limits& limits, std::string& out) {
  const auto* found = std::get_if<std::string>(&value.value);
  if (found == nullptr) {
    add(value.line, value.column, fmt::format("{} is {}", path, found_text(value)), type_text(out, limits),
        "write it in quotes");
    return;
  }
  if (!limits.choices.empty() &&
      std::find(limits.choices.begin(), limits.choices.end(), *found) == limits.choices.end()) {
    const std::vector<std::string> known(limits.choices.begin(), limits.choices.end());
    add(value.line, value.column, fmt::format("{} is {}", path, found_text(value)), type_text(out, limits),
        did_you_mean(*found, known, "use one of these"));
    return;
  }
  const auto is_control = [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; };
  if (std::any_of(found->begin(), found->end(), is_control)) {  // Names become columns of tables and lines of logs.
    add(value.line, value.column, fmt::format("{} holds a line break or a control character", path),
        "printable text in one line", "remove the character");
    return;
  }
  out = *found;
}

void FieldReader::read(const TomlValue& value, const std::string& path, const Limits& limits, Vec3d& out) {
  const auto* items = std::get_if<TomlArray>(&value.value);
  if (items == nullptr || items->size() != 3) {
    wrong_type(value, path, type_text(out, limits));
    return;
  }
  read((*items)[0], path + ".x", limits, out.x);
  read((*items)[1], path + ".y", limits, out.y);
  read((*items)[2], path + ".z", limits, out.z);
}

}  // namespace fexp::io
