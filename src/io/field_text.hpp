// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/field.hpp"
#include "base/short_list.hpp"
#include "base/vec3.hpp"

/// What the deck's parser and its reference say about the types of fields.
namespace fexp::io {

/// A structure that documents its own fields: a table in the deck.
template <class T>
concept HasFields = requires {
  T::fields;
};

template <class T>
struct IsVariant : std::false_type {};
template <class... T>
struct IsVariant<std::variant<T...>> : std::true_type {};

/// What a number or a text may be.
struct Limits {
  Range range{};
  Choices choices{};
};

/// Numbers in a deck are zero or between these in size, which leaves room for squares and products.
inline constexpr double smallest_number = 1.0e-100;
inline constexpr double largest_number = 1.0e100;

[[nodiscard]] inline std::string in_words(const Range& range) {
  return range.text == any_number.text ? "" : fmt::format(" ({})", range.text);
}
[[nodiscard]] std::string one_of(Choices choices);

/// The type as the deck's user reads it; overloads for what a member can be.
[[nodiscard]] inline std::string type_text(const bool&, const Limits&) { return "true or false"; }
[[nodiscard]] inline std::string type_text(const int&, const Limits& limits) {
  return "a whole number" + in_words(limits.range);
}
[[nodiscard]] inline std::string type_text(const double&, const Limits& limits) {
  return "a number" + in_words(limits.range);
}
[[nodiscard]] inline std::string type_text(const std::string&, const Limits& limits) {
  return limits.choices.empty() ? "a text" : one_of(limits.choices);
}
[[nodiscard]] inline std::string type_text(const Vec3d&, const Limits&) { return "three numbers [x, y, z]"; }
template <std::size_t N>
[[nodiscard]] std::string type_text(const std::array<int, N>&, const Limits& limits) {
  return fmt::format("{} whole numbers{}", N, in_words(limits.range));
}
template <std::size_t N>
[[nodiscard]] std::string type_text(const std::array<double, N>&, const Limits& limits) {
  return fmt::format("{} numbers{}", N, in_words(limits.range));
}
template <std::size_t N>
[[nodiscard]] std::string type_text(const std::array<std::string, N>&, const Limits&) {
  return fmt::format("{} texts", N);
}
template <HasFields T>
[[nodiscard]] std::string type_text(const T&, const Limits&) {
  return "a table";
}
template <class... T>
[[nodiscard]] std::string type_text(const std::variant<T...>&, const Limits&) {
  return "a table with a kind";
}
template <class T>
[[nodiscard]] std::string type_text(const std::vector<T>&, const Limits& limits) {
  if constexpr (HasFields<T>) {
    return "a list of tables";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return limits.choices.empty() ? "a list of texts" : "a list of " + one_of(limits.choices);
  } else {
    return fmt::format("a list of [{}]", type_text(T{}, limits));
  }
}
template <class T, std::size_t Capacity>
[[nodiscard]] std::string type_text(const ShortList<T, Capacity>&, const Limits& limits) {
  return type_text(std::vector<T>{}, limits);
}
template <class T>
[[nodiscard]] std::string type_text(const std::optional<T>&, const Limits& limits) {
  return type_text(T{}, limits);
}

/// Calls `visit(T{})` for every alternative of a variant, those of variants inside it included.
template <class Variant, class Visit>
void for_each_alternative(const Visit& visit) {
  const auto one = [&visit]<class T>(std::type_identity<T>) {
    if constexpr (IsVariant<T>::value) {
      for_each_alternative<T>(visit);
    } else {
      visit(T{});
    }
  };
  [&]<class... T>(std::type_identity<std::variant<T...>>) {
    (one(std::type_identity<T>{}), ...);
  }(std::type_identity<Variant>{});
}

/// The kinds of a variant's alternatives, in order.
template <class Variant>
[[nodiscard]] std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for_each_alternative<Variant>([&names](const auto& alternative) { names.emplace_back(alternative.kind); });
  return names;
}

/// Calls `visit(field)` for every field of a structure, in order.
template <HasFields Struct, class Visit>
void for_each_field(const Visit& visit) {
  std::apply([&visit](const auto&... field) { (visit(field), ...); }, Struct::fields);
}

/// The names of a structure's fields, in order.
template <HasFields Struct>
[[nodiscard]] std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for_each_field<Struct>([&names](const auto& field) { names.emplace_back(field.name); });
  return names;
}

}  // namespace fexp::io
