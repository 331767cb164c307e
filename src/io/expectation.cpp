// SPDX-License-Identifier: Apache-2.0
#include "io/expectation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace fexp::io {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// (time, value), times ascending.
using Course = std::vector<std::pair<double, double>>;

std::string_view without_unit(std::string_view header) {
  const std::size_t bracket = header.find(" [");
  return header.substr(0, bracket);
}

std::optional<std::size_t> find_column(const CsvTable& table, std::string_view name) {
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (without_unit(table.header[i]) == name) {
      return i;
    }
  }
  return std::nullopt;
}

std::string column_names(const CsvTable& table) {
  std::string names;
  for (const std::string& header : table.header) {
    names += (names.empty() ? "" : ", ") + std::string(without_unit(header));
  }
  return names;
}

double number_in(std::string_view cell) {
  double value = no_number;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? value : no_number;
}

/// Columns that rows are chosen by, and what must stand in them.
std::vector<std::pair<std::string, std::string>> selections(const Expectation& e) {
  std::vector<std::pair<std::string, std::string>> chosen;
  if (!e.set.empty()) {
    chosen.emplace_back("set", e.set);
  }
  if (!e.body.empty()) {
    chosen.emplace_back("body", e.body);
  }
  if (e.node != Expectation::any_node) {
    chosen.emplace_back("node", std::to_string(e.node));
  }
  return chosen;
}

/// One value from those of a moment.
class Gathering {
 public:
  void add(double value) {
    sum_ += value;
    smallest_ = std::min(smallest_, value);
    largest_ = std::max(largest_, value);
    ++count_;
  }
  [[nodiscard]] double value(std::string_view way) const {
    return way == "sum" ? sum_ : way == "smallest" ? smallest_ : way == "largest" ? largest_ : sum_ / count_;
  }

 private:
  double sum_{};
  double smallest_{HUGE_VAL};
  double largest_{-HUGE_VAL};
  int count_{};
};

/// The value at every time that has rows which the expectation chooses.
Course course_of(const Expectation& e, const CsvTable& table, ErrorList& errors) {
  const auto lacks = [&](const std::string& name) {
    errors.add(e.place, fmt::format("expect \"{}\": {}.csv has no column \"{}\"", e.name, e.history, name),
               column_names(table), "correct the name, or choose another history");
  };
  const std::optional<std::size_t> time = find_column(table, "time"), value = find_column(table, e.column);
  std::vector<std::pair<std::size_t, std::string>> chosen;
  for (auto& [name, wanted] : selections(e)) {
    const std::optional<std::size_t> column = find_column(table, name);
    if (!column) {
      lacks(name);
      return {};
    }
    chosen.emplace_back(*column, std::move(wanted));
  }
  if (!time || !value) {
    lacks(time ? e.column : "time");
    return {};
  }
  Course course;
  Gathering gathering;
  const auto close = [&] {
    if (!course.empty()) {
      course.back().second = gathering.value(e.over_rows);
    }
  };
  for (const std::vector<std::string>& row : table.rows) {
    const double when = number_in(row[*time]);
    const bool taken = when >= e.from && std::ranges::all_of(chosen, [&](const auto& selection) {
                         return row[selection.first] == selection.second;
                       });
    if (!taken) {
      continue;
    }
    if (course.empty() || course.back().first != when) {
      close();
      course.emplace_back(when, 0.0);
      gathering = {};
    }
    gathering.add(number_in(row[*value]));
  }
  close();
  if (course.empty()) {
    errors.add(e.place, fmt::format("expect \"{}\": no row of {}.csv is chosen", e.name, e.history),
               "rows of the set, body and node from the time on",
               "name the set or body under [output], or correct the selection");
  }
  return course;
}

double value_at(const Expectation& e, const Course& course, ErrorList& errors) {
  if (!(e.time >= course.front().first && e.time <= course.back().first)) {
    errors.add(e.place, fmt::format("expect \"{}\": time is {:g}", e.name, e.time),
               fmt::format("{:g} to {:g}", course.front().first, course.back().first),
               "correct the time, or the duration of the run");
    return no_number;
  }
  const auto after = std::ranges::lower_bound(course, e.time, {}, &std::pair<double, double>::first);
  if (after->first == e.time) {
    return after->second;
  }
  const auto before = after - 1;
  const double part = (e.time - before->first) / (after->first - before->first);
  return before->second + part * (after->second - before->second);
}

}  // namespace

double expected_number(const Expectation& e, const CsvTable& history, ErrorList& errors) {
  const Course course = course_of(e, history, errors);
  if (course.empty()) {
    return no_number;
  }
  if (e.over_time == "at") {
    return value_at(e, course, errors);
  }
  if (e.over_time == "first") {
    return course.front().second;
  }
  if (e.over_time == "last") {
    return course.back().second;
  }
  double sum = 0.0, smallest = HUGE_VAL, largest = -HUGE_VAL;
  for (const auto& [time, value] : course) {
    sum += value;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  if (e.over_time == "mean") {
    return sum / static_cast<double>(course.size());
  }
  const bool low = e.over_time == "smallest" || (e.over_time == "farthest" && -smallest > largest);
  return low ? smallest : largest;
}

double error_of(const Expectation& e, double result) noexcept {
  const double difference = std::abs(result - e.reference);
  return e.reference == 0.0 ? difference : difference / std::abs(e.reference);
}

}  // namespace fexp::io
