// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/errors.hpp"

/// TOML as plain values, so that toml++, which takes seconds to compile, is included in one file only.
namespace fexp::io {

struct TomlValue;
struct TomlEntry;
using TomlArray = std::vector<TomlValue>;
using TomlTable = std::vector<TomlEntry>;

/// A date or a time; no field takes one.
struct TomlDate {};

struct TomlValue {
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> value;
  int line{};
  int column{};
};

struct TomlEntry {
  std::string key;
  int line{};
  int column{};
  TomlValue value;
};

/// The root table, or an error and nothing when the text is no TOML.
[[nodiscard]] std::optional<TomlValue> read_toml(std::string_view text, const std::string& file, ErrorList& errors);

/// The entry of that key, or null.
[[nodiscard]] const TomlEntry* find_entry(const TomlTable& table, std::string_view key);

/// What a value is, as an error tells it: `the text "abc"`, `the number 1.5`, `a list of 3 values`.
[[nodiscard]] std::string found_text(const TomlValue& value);

}  // namespace fexp::io
