// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string_view>

namespace fexp {

/// Accepted range of a number, with the words a user reads in an error and in the manual.
struct Range {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  bool low_included{true};
  bool high_included{true};
  std::string_view text{"any finite number"};

  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    const bool above = low_included ? value >= low : value > low;
    const bool below = high_included ? value <= high : value < high;
    const bool finite = value - value == 0.0;
    return above && below && finite;
  }
};

inline constexpr Range any_number{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), false, true, "> 0"};
inline constexpr Range non_negative{0.0, std::numeric_limits<double>::infinity(), true, true, ">= 0"};
/// Of damping as a part of the critical one.
inline constexpr Range damping_range{0.0, 1.0, true, true, ">= 0 and <= 1"};

/// The words a text may be; none: any text.
using Choices = std::span<const std::string_view>;

enum class Presence { optional, required };

/// One named, documented member of an input structure. The deck's parser, its writer and the manual are generated
/// from tuples of these, so that they cannot disagree.
template <class Struct, class Value>
struct Field {
  using StructType = Struct;
  using ValueType = Value;

  std::string_view name;
  std::string_view unit;     ///< Dimension, as the manual prints it ("length", "force/length^2", "-").
  std::string_view meaning;  ///< One sentence for the manual.
  Value Struct::*member;
  Range range{};
  Presence presence{Presence::optional};
  Choices choices{};

  constexpr Field(std::string_view name_, std::string_view unit_, std::string_view meaning_, Value Struct::*member_,
                  Range range_ = any_number, Presence presence_ = Presence::optional)
      : name(name_), unit(unit_), meaning(meaning_), member(member_), range(range_), presence(presence_) {}
  constexpr Field(std::string_view name_, std::string_view unit_, std::string_view meaning_, Value Struct::*member_,
                  Choices choices_, Presence presence_ = Presence::optional)
      : name(name_), unit(unit_), meaning(meaning_), member(member_), presence(presence_), choices(choices_) {}
};

}  // namespace fexp
