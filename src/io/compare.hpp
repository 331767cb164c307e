// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/index.hpp"

namespace fexp::io {

/// The first entry in which two hash logs differ.
struct HashDifference {
  std::int64_t step{};
  Index body{};
  std::string body_name;  ///< Empty when no results name it.
  std::string hash_a;     ///< 16 hexadecimal digits, or "missing"
  std::string hash_b;
};

/// The first value in which the frames of two runs differ bit by bit.
struct ValueDifference {
  std::int64_t frame{};
  std::int64_t step{};
  double time{};         ///< Of run A [time]
  std::string field;     ///< "position", or a field of the results
  bool at_node{};        ///< A node's value, otherwise an element's
  Index index{};         ///< Node or element
  std::int64_t label{};  ///< The user's number of it
  Index body{};
  std::string body_name;
  std::vector<double> a;  ///< All components, shape [components]
  std::vector<double> b;
};

/// What two runs have in common and where they part.
struct Comparison {
  bool comparable{};               ///< There was something to compare.
  bool same{};                     ///< Comparable, and all that both runs wrote is the same, bit by bit.
  std::vector<std::string> notes;  ///< What was compared, what one run lacks, what does not fit; one sentence each.
  std::optional<HashDifference> hash;
  std::optional<ValueDifference> value;

  /// Several lines for a reader, the verdict first.
  [[nodiscard]] std::string text() const;
};

/// Compares two run directories (or results files) by their hash logs and by their frames. Throws OutputError when a
/// file cannot be read.
[[nodiscard]] Comparison compare_runs(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace fexp::io
