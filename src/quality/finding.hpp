// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What is allowed in a model but may not be meant.
namespace fexp::quality {

/// A note says what is so; a warning says what is likely wrong.
enum class Severity { note, warning };

/// Most ids that a finding names; `count` says how many there are.
inline constexpr std::size_t most_ids = 8;

/// Something about a model that its user may want to know, with the user's own names for all it speaks of.
struct Finding {
  std::string_view kind;  ///< One word for programs, e.g. "duplicate_nodes"
  Severity severity{Severity::warning};
  std::string body;                     ///< Name in the deck; empty: the model as a whole
  std::string other_body;               ///< The second of two bodies that are concerned; empty: only one
  std::string message;                  ///< What is so, with numbers and units
  std::string cure;                     ///< What it may mean and what helps; empty when there is nothing to do
  std::string_view item;                ///< What `ids` are of: "node" or "element"
  std::int64_t count{};                 ///< Of the items concerned
  std::vector<std::int64_t> ids;        ///< Labels of the first of them, at most most_ids
  std::vector<std::int64_t> other_ids;  ///< Where items come in pairs: the second of each, as many as ids
  std::vector<std::pair<std::string_view, double>> numbers;  ///< By name, in the deck's units
};

}  // namespace fexp::quality
