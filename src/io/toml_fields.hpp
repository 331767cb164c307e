// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/field_text.hpp"
#include "io/toml_value.hpp"

namespace fexp::io {

/// Fills structures from TOML by their `fields`. Everything wrong becomes an error; the member then keeps what it had.
/// `path` is how errors name a value: "run.safety", "body.mesh". Structures with a member `place` get that of their
/// table.
class FieldReader {
 public:
  /// Errors beyond these are not taken: one mistake can repeat itself a million times in a list.
  static constexpr std::size_t most_errors = 100;

  FieldReader(std::string file, ErrorList& errors) : file_(std::move(file)), errors_(errors) {}

  /// Reads all fields from a table. Keys that are neither fields nor `others` are errors.
  template <HasFields Struct>
  void table(const TomlValue& value, const std::string& path, Struct& out, std::span<const std::string> others = {}) {
    if constexpr (requires { out.place; }) {
      out.place = place(value);
    }
    noting_faults(value, [&] {
      if (const TomlTable* entries = as_table(value, path)) {
        members(value, *entries, path, out);
        std::vector<std::string> known = field_names<Struct>();
        known.insert(known.end(), others.begin(), others.end());
        check_keys(*entries, path, known);
      }
    });
  }

  /// Calls `read`, and notes the value's place when that added an error.
  template <class Read>
  void noting_faults(const TomlValue& value, const Read& read) {
    const std::size_t before = errors_.size();
    read();
    if (errors_.size() != before) {
      faulty_.emplace(value.line, value.column);
    }
  }
  /// Whether reading the table at that place added errors.
  [[nodiscard]] bool is_faulty(const Place& table) const { return faulty_.contains({table.line, table.column}); }

  /// Reads all fields from a table's entries, whatever else is there.
  template <HasFields Struct>
  void members(const TomlValue& value, const TomlTable& entries, const std::string& path, Struct& out) {
    for_each_field<Struct>([&](const auto& field) {
      const TomlEntry* entry = find_entry(entries, field.name);
      const Limits limits{field.range, field.choices};
      if (entry != nullptr) {
        read(entry->value, fmt::format("{}.{}", path, field.name), limits, out.*field.member);
      } else if (field.presence == Presence::required) {
        missing_key(value, path, field.name, type_text(out.*field.member, limits), field.meaning);
      }
    });
  }

  /// Reads the alternative whose kind the key `selector` of the table names; the first one when `selector` may be left
  /// out and is. `others` are keys of the same table that somebody else reads.
  template <class... T>
  void alternative(const TomlValue& value, const std::string& path, std::string_view selector, Presence presence,
                   std::variant<T...>& out, std::span<const std::string> others = {}) {
    using Variant = std::variant<T...>;
    const std::string kind = chosen_kind(value, path, selector, presence, kinds<Variant>());
    std::vector<std::string> known(others.begin(), others.end());
    known.emplace_back(selector);
    for_each_alternative<Variant>([&]<class Alternative>(Alternative parameters) {
      if (kind == Alternative::kind) {
        const std::size_t before = errors_.size();
        table(value, path, parameters, known);
        if (errors_.size() == before) {
          out = parameters;
        }
      }
    });
  }

  /// The table's entries, or an error and null when the value is none.
  const TomlTable* as_table(const TomlValue& value, const std::string& path);
  /// The items of a list of tables; an error when the value is no list.
  const TomlArray* as_list_of_tables(const TomlValue& value, const std::string& path);
  /// Reports keys that are not known, with the nearest that is. An empty path is the deck itself.
  void check_keys(const TomlTable& table, const std::string& path, std::span<const std::string> known);

  void read(const TomlValue& value, const std::string& path, const Limits& limits, bool& out);
  void read(const TomlValue& value, const std::string& path, const Limits& limits, int& out);
  void read(const TomlValue& value, const std::string& path, const Limits& limits, double& out);
  void read(const TomlValue& value, const std::string& path, const Limits& limits, std::string& out);
  void read(const TomlValue& value, const std::string& path, const Limits& limits, Vec3d& out);

  template <HasFields Struct>
  void read(const TomlValue& value, const std::string& path, const Limits&, Struct& out) {
    table(value, path, out);
  }
  template <class... T>
  void read(const TomlValue& value, const std::string& path, const Limits&, std::variant<T...>& out) {
    alternative(value, path, "kind", Presence::required, out);
  }
  template <class T>
  void read(const TomlValue& value, const std::string& path, const Limits& limits, std::optional<T>& out) {
    read(value, path, limits, out.emplace());
  }
  template <class T, std::size_t N>
  void read(const TomlValue& value, const std::string& path, const Limits& limits, std::array<T, N>& out) {
    const auto* items = std::get_if<TomlArray>(&value.value);
    if (items == nullptr || items->size() != N) {
      wrong_type(value, path, type_text(out, limits));
      return;
    }
    for (std::size_t i = 0; i < N; ++i) {
      read((*items)[i], item_path(path, i), limits, out[i]);
    }
  }
  template <class T>
  void read(const TomlValue& value, const std::string& path, const Limits& limits, std::vector<T>& out) {
    const TomlArray* items = nullptr;
    if constexpr (HasFields<T>) {
      items = as_list_of_tables(value, path);
    } else {
      items = std::get_if<TomlArray>(&value.value);
      if (items == nullptr) {
        wrong_type(value, path, type_text(out, limits));
      }
    }
    if (items == nullptr) {
      return;
    }
    out.clear();
    out.reserve(items->size());
    const std::size_t errors = errors_.size();
    for (std::size_t i = 0; i < items->size(); ++i) {
      read((*items)[i], item_path(path, i), limits, out.emplace_back());
    }
    // Values that stand for wrong ones could be taken for other mistakes.
    if (!HasFields<T> && errors_.size() != errors) {
      out.clear();
    }
  }
  template <class T, std::size_t Capacity>
  void read(const TomlValue& value, const std::string& path, const Limits& limits, ShortList<T, Capacity>& out) {
    std::vector<T> items;
    read(value, path, limits, items);
    if (items.size() > Capacity) {
      add(value.line, value.column, fmt::format("{} has {} items", path, items.size()),
          fmt::format("{} items at most", Capacity), "leave out those that matter least");
      return;
    }
    for (const T& item : items) {
      out.append(item);
    }
  }

  [[nodiscard]] Place place(const TomlValue& value) const { return {file_, value.line, value.column}; }
  void add(int line, int column, std::string message, std::string accepted, std::string cure);
  /// Whether so many errors were found that no more are taken.
  [[nodiscard]] bool is_full() const noexcept { return errors_.size() >= most_errors; }

 private:
  void wrong_type(const TomlValue& value, const std::string& path, const std::string& accepted);
  void missing_key(const TomlValue& table, const std::string& path, std::string_view key, const std::string& accepted,
                   std::string_view meaning);
  [[nodiscard]] std::string chosen_kind(const TomlValue& table, const std::string& path, std::string_view selector,
                                        Presence presence, const std::vector<std::string>& kinds);
  [[nodiscard]] static std::string item_path(const std::string& path, std::size_t index) {
    return fmt::format("{}[{}]", path, index + 1);
  }

  std::string file_;
  ErrorList& errors_;
  std::set<std::pair<int, int>> faulty_;  // line, column
};

}  // namespace fexp::io
