// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/expectation.hpp"

/// What "fexp verify" finds, as text and as JSON.
namespace fexp::app {

/// One expectation, held against a run.
struct VerifyRow {
  std::string name;  ///< Of the case: its deck's file name without the ending
  std::string deck;
  std::string title;
  std::int64_t elements{};
  double factor{1.0};  ///< By which the deck's mesh is refined
  io::Expectation expected;
  double result{};
  double error{};

  [[nodiscard]] bool is_held() const { return io::is_held(expected, factor); }
  [[nodiscard]] bool is_wrong() const { return is_held() && !(error <= expected.tolerance); }
};

/// One expectation over a series of refined meshes.
struct VerifySeries {
  std::vector<VerifyRow> rows;  ///< From the coarsest mesh to the finest
  std::optional<double> order;  ///< Observed on the two finest meshes, or the three finest without exact reference
  std::optional<double> limit;  ///< What the results converge to, where that is not the reference

  [[nodiscard]] const io::Expectation& expected() const { return rows.front().expected; }
  [[nodiscard]] bool is_wrong() const {
    return expected().least_order >= 0.0 && !(order && *order >= expected().least_order);
  }
};

/// All that was found.
struct VerifyFindings {
  std::vector<VerifyRow> rows;
  std::vector<VerifySeries> series;
  std::vector<std::string> stopped;  ///< Cases whose runs did not come to their end

  [[nodiscard]] std::int64_t held() const;   ///< Rows and series that something is asked of
  [[nodiscard]] std::int64_t wrong() const;  ///< Those of them that are not as expected
};

/// The series of every expectation that is one of them: `rows` are those of one case on all its meshes, coarse to fine.
[[nodiscard]] std::vector<VerifySeries> series_of(const std::vector<VerifyRow>& rows);

/// Head of the table that row_text continues; `width` is that of the cases' names.
[[nodiscard]] std::string head_text(std::size_t width);
[[nodiscard]] std::string row_text(const VerifyRow& row, std::size_t width);
[[nodiscard]] std::string series_text(const VerifySeries& series, std::size_t width);
[[nodiscard]] std::string sum_text(const VerifyFindings& findings);
[[nodiscard]] nlohmann::ordered_json to_json(const VerifyFindings& findings);

}  // namespace fexp::app
