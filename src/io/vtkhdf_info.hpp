// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace fexp::io {

/// Smallest and largest value of a field over all frames; of vectors and resultants, component by component.
struct FieldRange {
  std::string name;
  std::string unit;  ///< Dimension
  std::string meaning;
  bool at_node{};
  int components{};
  double low{};
  double high{};
  std::int64_t not_finite{};  ///< Values that are infinite or not a number
};

/// What a results file or run directory holds.
struct ResultsInfo {
  std::filesystem::path results;
  std::string title;
  std::string program;
  std::int64_t nodes{};
  std::int64_t elements{};
  std::vector<std::string> bodies;
  std::vector<double> times;
  std::vector<std::int64_t> steps;
  std::vector<FieldRange> fields;  ///< "position" first; empty without frames
  std::uintmax_t bytes{};
  /// "complete", "ended early: <why>" or "unfinished: the run goes on or was killed"; "unknown" for a bare file.
  std::string completeness;
  std::vector<std::string> histories;  ///< CSV files beside the results

  /// Several lines for a reader.
  [[nodiscard]] std::string text() const;
};

/// Reads a results file, or a run directory with its summary. Throws OutputError.
[[nodiscard]] ResultsInfo read_info(const std::filesystem::path& path);

[[nodiscard]] nlohmann::ordered_json to_json(const ResultsInfo& info);

}  // namespace fexp::io
