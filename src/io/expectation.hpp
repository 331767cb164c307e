// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "io/history.hpp"

namespace fexp::io {

/// What a run is expected to give: a number taken from one column of a history, and a reference for it. "fexp verify"
/// runs the deck and holds one against the other; a plain run takes no notice.
struct Expectation {
  static constexpr std::array<std::string_view, 6> histories{"energies", "momenta", "steps",
                                                             "planes",   "nodes",   "bodies"};
  static constexpr std::array<std::string_view, 4> ways_over_rows{"mean", "sum", "smallest", "largest"};
  static constexpr std::array<std::string_view, 7> ways_over_time{"first",    "last", "smallest", "largest",
                                                                  "farthest", "mean", "at"};
  /// No label of a node is so low.
  static constexpr int any_node = -1;

  std::string name;
  std::string history{"nodes"};
  std::string column;
  std::string set;
  std::string body;
  int node{any_node};
  std::string over_rows{"mean"};
  std::string over_time{"last"};
  double from{0.0};   ///< [time]
  double time{-1.0};  ///< [time]; negative: not given
  double reference{};
  double tolerance{};
  std::string source;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "What the number is, such as \"peak deflection\".", &Expectation::name, any_number,
            Presence::required},
      Field{"history", "-", "The CSV file that has it.", &Expectation::history, Choices(histories)},
      Field{"column", "-", "The column, by its name without the unit, such as \"displacement_z\".",
            &Expectation::column, any_number, Presence::required},
      Field{"set", "-", "Only rows of this node set.", &Expectation::set},
      Field{"body", "-", "Only rows of this body.", &Expectation::body},
      Field{"node", "-", "Only rows of the node with this label.", &Expectation::node, non_negative},
      Field{"over_rows", "-", "What becomes of several rows at the same time.", &Expectation::over_rows,
            Choices(ways_over_rows)},
      Field{"over_time", "-",
            "What becomes of the times: the first or last value, the smallest or largest, the one farthest from zero, "
            "the mean, or the value at `time`.",
            &Expectation::over_time, Choices(ways_over_time)},
      Field{"from", "time", "Only rows from this time on.", &Expectation::from, non_negative},
      Field{"time", "time", "The time for `over_time = \"at\"`, interpolated between rows.", &Expectation::time,
            non_negative},
      Field{"reference", "that of the column", "The value that is expected.", &Expectation::reference, any_number,
            Presence::required},
      Field{"tolerance", "-", "Largest error: relative to the reference, absolute where that is 0.",
            &Expectation::tolerance, non_negative, Presence::required},
      Field{"source", "-", "Where the reference comes from.", &Expectation::source},
  };
};

/// The expected number as a history has it. What is not in the history, rows that no selection leaves and times that
/// it does not reach are added to `errors`, and the number is then not finite.
[[nodiscard]] double expected_number(const Expectation& expectation, const CsvTable& history, ErrorList& errors);

/// |result - reference|, over |reference| where that is not 0.
[[nodiscard]] double error_of(const Expectation& expectation, double result) noexcept;

}  // namespace fexp::io
