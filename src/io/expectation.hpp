// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "io/history.hpp"

namespace fexp::io {

/// How "fexp verify" runs a deck.
struct VerifySettings {
  bool is_long{false};
  std::vector<double> meshes;  ///< Factors of refinement, ascending; 1 is the deck as it is
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"long", "-", "Run only with --all, or when it is named.", &VerifySettings::is_long},
      Field{"meshes", "-",
            "Factors, ascending and 1 among them, by which --all refines the meshes; from the results follows the "
            "observed order of convergence.",
            &VerifySettings::meshes, positive},
  };
};

/// Other rows of the same history; what is empty is as in the expectation.
struct Subtrahend {
  std::string column;
  std::string set;
  std::string body;
  std::optional<int> node;
  std::optional<int> element;

  static constexpr auto fields = std::tuple{
      Field{"column", "-", "The column, where it is another one.", &Subtrahend::column},
      Field{"set", "-", "The node set, where it is another one.", &Subtrahend::set},
      Field{"body", "-", "The body, where it is another one.", &Subtrahend::body},
      Field{"node", "-", "The node, where it is another one.", &Subtrahend::node, non_negative},
      Field{"element", "-", "The element, where it is another one.", &Subtrahend::element, non_negative},
  };
};

/// What a run is expected to give: a number taken from one column of a history, and a reference for it. "fexp verify"
/// runs the deck and holds one against the other; a plain run takes no notice.
struct Expectation {
  static constexpr std::array<std::string_view, 8> histories{"energies", "momenta", "steps",    "walls",
                                                             "ties",     "nodes",   "elements", "bodies"};
  static constexpr std::array<std::string_view, 4> ways_over_rows{"mean", "sum", "smallest", "largest"};
  static constexpr std::array<std::string_view, 10> ways_over_time{
      "first", "last", "smallest", "largest", "farthest", "time_of_farthest", "mean", "at", "crossing", "period"};
  /// No label is so low.
  static constexpr int any = -1;

  std::string name;
  std::string history{"nodes"};
  std::string column;
  std::string set;
  std::string body;
  int node{any};
  int element{any};
  std::string over_rows{"mean"};
  std::optional<Subtrahend> minus;
  bool relative_to_first{false};
  std::string over_time{"last"};
  double from{0.0};    ///< [time]
  double until{-1.0};  ///< [time]; negative: not given
  double time{-1.0};   ///< [time]; negative: not given
  double level{0.0};
  double reference{};
  double tolerance{};
  std::string source;
  double mesh{-1.0};  ///< Factor of refinement; negative: all meshes
  bool exact{false};
  double least_order{-1.0};  ///< Negative: not given
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
      Field{"element", "-", "Only rows of the element with this label.", &Expectation::element, non_negative},
      Field{"over_rows", "-", "What becomes of several rows at the same time.", &Expectation::over_rows,
            Choices(ways_over_rows)},
      Field{"minus", "-", "Other rows of the same history, whose values are subtracted.", &Expectation::minus},
      Field{"relative_to_first", "-", "Values are divided by the first one.", &Expectation::relative_to_first},
      Field{"over_time", "-",
            "What becomes of the times: the first or last value, the smallest or largest, the one farthest from zero "
            "or its time, the mean, the value at `time`, the time of the first crossing of `level`, or the mean period "
            "of the upward crossings of `level`.",
            &Expectation::over_time, Choices(ways_over_time)},
      Field{"from", "time", "Only rows from this time on.", &Expectation::from, non_negative},
      Field{"until", "time", "Only rows up to this time.", &Expectation::until, non_negative},
      Field{"time", "time", "The time for `over_time = \"at\"`, interpolated between rows.", &Expectation::time,
            non_negative},
      Field{"level", "that of the column", "The value for \"crossing\" and \"period\".", &Expectation::level},
      Field{"reference", "that of the result", "The value that is expected.", &Expectation::reference, any_number,
            Presence::required},
      Field{"tolerance", "-", "Largest error: relative to the reference, absolute where that is 0.",
            &Expectation::tolerance, non_negative, Presence::required},
      Field{"source", "-", "Where the reference comes from.", &Expectation::source},
      Field{"mesh", "-",
            "Only on the mesh refined by this factor. Others are held to their tolerance on the deck's own mesh and "
            "finer ones, and listed on coarser ones.",
            &Expectation::mesh, positive},
      Field{"exact", "-",
            "Meshes converge to the reference, which the order is towards; otherwise it follows from three meshes.",
            &Expectation::exact},
      Field{"least_order", "-", "Least order of convergence to be observed.", &Expectation::least_order, non_negative},
  };
};

/// Whether an expectation is one of the series of refined meshes.
[[nodiscard]] inline bool in_series(const Expectation& expectation) noexcept { return expectation.mesh < 0.0; }

/// Whether the result on the mesh of that factor is held to the tolerance.
[[nodiscard]] inline bool is_held(const Expectation& expectation, double factor) noexcept {
  return in_series(expectation) ? factor >= 1.0 : factor == expectation.mesh;
}

/// Adds what is wrong with the meshes to be run, and between them and the expectations.
void check_expectations(const VerifySettings& settings, std::span<const Expectation> expectations, ErrorList& errors);

/// The expected number as a history has it. What is not in the history, rows that no selection leaves and times that
/// it does not reach are added to `errors`, and the number is then not finite.
[[nodiscard]] double expected_number(const Expectation& expectation, const CsvTable& history, ErrorList& errors);

/// |result - reference|, over |reference| where that is not 0.
[[nodiscard]] double error_of(const Expectation& expectation, double result) noexcept;

}  // namespace fexp::io
