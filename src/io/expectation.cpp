// SPDX-License-Identifier: Apache-2.0
#include "io/expectation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "io/convergence.hpp"

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

/// What is taken from a history: a column, and the rows by what must stand in others.
struct Selection {
  std::string column;
  std::vector<std::pair<std::string, std::string>> rows;
};

Selection selection_of(const std::string& column, const std::string& set, const std::string& body, int node,
                       int element) {
  Selection selection{column, {}};
  if (!set.empty()) {
    selection.rows.emplace_back("set", set);
  }
  if (!body.empty()) {
    selection.rows.emplace_back("body", body);
  }
  if (node != Expectation::any) {
    selection.rows.emplace_back("node", std::to_string(node));
  }
  if (element != Expectation::any) {
    selection.rows.emplace_back("element", std::to_string(element));
  }
  return selection;
}

Selection minuend(const Expectation& e) { return selection_of(e.column, e.set, e.body, e.node, e.element); }

Selection subtrahend(const Expectation& e) {
  const Subtrahend& m = *e.minus;
  return selection_of(m.column.empty() ? e.column : m.column, m.set.empty() ? e.set : m.set,
                      m.body.empty() ? e.body : m.body, m.node.value_or(e.node), m.element.value_or(e.element));
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

/// The value at every time that has rows which the selection chooses.
Course course_of(const Expectation& e, const Selection& selection, const CsvTable& table, ErrorList& errors) {
  const auto lacks = [&](const std::string& name) {
    errors.add(e.place, fmt::format("expect \"{}\": {}.csv has no column \"{}\"", e.name, e.history, name),
               column_names(table), "correct the name, or choose another history");
  };
  const std::optional<std::size_t> time = find_column(table, "time"), value = find_column(table, selection.column);
  std::vector<std::pair<std::size_t, std::string>> chosen;
  for (const auto& [name, wanted] : selection.rows) {
    const std::optional<std::size_t> column = find_column(table, name);
    if (!column) {
      lacks(name);
      return {};
    }
    chosen.emplace_back(*column, wanted);
  }
  if (!time || !value) {
    lacks(time ? selection.column : "time");
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
    const bool taken = when >= e.from && (e.until < 0.0 || when <= e.until) &&
                       std::ranges::all_of(chosen, [&](const auto& one) { return row[one.first] == one.second; });
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
               "rows of the set, body, node and element between the times",
               "name the set or body under [output], or correct the selection");
  }
  return course;
}

/// Takes the values of the rows that the expectation subtracts.
void subtract(const Expectation& e, const CsvTable& table, Course& course, ErrorList& errors) {
  const Course other = course_of(e, subtrahend(e), table, errors);
  if (other.size() != course.size()) {  // Only where rows are missing, which is an error already.
    course.clear();
    return;
  }
  for (std::size_t i = 0; i < course.size(); ++i) {
    course[i].second -= other[i].second;
  }
}

void divide_by_first(const Expectation& e, Course& course, ErrorList& errors) {
  const double first = course.front().second;
  if (first == 0.0) {
    errors.add(e.place, fmt::format("expect \"{}\": the first value is 0", e.name), "a first value that is not 0",
               "remove relative_to_first, or begin later with from");
    course.clear();
    return;
  }
  for (auto& [time, value] : course) {
    value /= first;
  }
}

/// Times at which the course passes the level, upwards or in both directions.
std::vector<double> crossings(const Course& course, double level, bool upwards_only) {
  std::vector<double> times;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const auto& [t0, v0] = course[i - 1];
    const auto& [t1, v1] = course[i];
    const bool up = v0 < level && v1 >= level, down = v0 > level && v1 <= level;
    if (up || (down && !upwards_only)) {
      times.push_back(t0 + (t1 - t0) * (level - v0) / (v1 - v0));
    }
  }
  return times;
}

double crossing_or_period(const Expectation& e, const Course& course, ErrorList& errors) {
  const bool period = e.over_time == "period";
  const std::vector<double> times = crossings(course, e.level, period);
  const std::size_t fewest = period ? 2 : 1;
  if (times.size() < fewest) {
    errors.add(e.place,
               fmt::format("expect \"{}\": the level {:g} is passed {}{} times", e.name, e.level,
                           period ? "upwards " : "", times.size()),
               fmt::format("{} or more", fewest), "correct the level, or the duration of the run");
    return no_number;
  }
  return period ? (times.back() - times.front()) / static_cast<double>(times.size() - 1) : times.front();
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

void check_meshes(const VerifySettings& settings, ErrorList& errors) {
  const std::vector<double>& meshes = settings.meshes;
  const bool ascending = std::ranges::adjacent_find(meshes, std::ranges::greater_equal{}) == meshes.end();
  if (!meshes.empty() && (meshes.size() < 2 || !ascending || std::ranges::find(meshes, 1.0) == meshes.end())) {
    errors.add(settings.place, fmt::format("verify.meshes is [{}]", fmt::join(meshes, ", ")),
               "two or more factors, ascending, 1 among them", "correct the factors, or remove the list");
  }
}

/// Whether an order can be told without a reference.
bool has_three_meshes(const std::vector<double>& meshes) {
  const std::size_t n = meshes.size();
  return n >= 3 && refined_evenly(meshes[n - 3], meshes[n - 2], meshes[n - 1]);
}

}  // namespace

void check_expectations(const VerifySettings& settings, std::span<const Expectation> expectations, ErrorList& errors) {
  check_meshes(settings, errors);
  const std::vector<double>& meshes = settings.meshes;
  for (const Expectation& e : expectations) {
    if (!in_series(e) && e.mesh != 1.0 && std::ranges::find(meshes, e.mesh) == meshes.end()) {
      errors.add(e.place, fmt::format("expect \"{}\": the mesh refined by {:g} is not run", e.name, e.mesh),
                 fmt::format("1{}{}", meshes.empty() ? "" : ", or one of ", fmt::join(meshes, ", ")),
                 "add the factor to verify.meshes, or correct it");
    }
    if (e.least_order >= 0.0 && (!in_series(e) || meshes.empty())) {
      errors.add(e.place, fmt::format("expect \"{}\": least_order is given without refined meshes", e.name),
                 "an order where verify.meshes is given and mesh is not", "add verify.meshes, or remove least_order");
    } else if (e.least_order >= 0.0 && !e.exact && !has_three_meshes(meshes)) {
      errors.add(e.place,
                 fmt::format("expect \"{}\": no order follows from the meshes [{}]", e.name, fmt::join(meshes, ", ")),
                 "an exact reference, or three meshes at least, the last three refined by one ratio",
                 "set exact = true where meshes converge to the reference, or correct verify.meshes");
    }
  }
}

double expected_number(const Expectation& e, const CsvTable& history, ErrorList& errors) {
  Course course = course_of(e, minuend(e), history, errors);
  if (e.minus && !course.empty()) {
    subtract(e, history, course, errors);
  }
  if (e.relative_to_first && !course.empty()) {
    divide_by_first(e, course, errors);
  }
  if (course.empty()) {
    return no_number;
  }
  if (e.over_time == "at") {
    return value_at(e, course, errors);
  }
  if (e.over_time == "crossing" || e.over_time == "period") {
    return crossing_or_period(e, course, errors);
  }
  if (e.over_time == "first") {
    return course.front().second;
  }
  if (e.over_time == "last") {
    return course.back().second;
  }
  if (e.over_time == "mean") {
    const double sum = std::accumulate(course.begin(), course.end(), 0.0,
                                       [](double part, const auto& point) { return part + point.second; });
    return sum / static_cast<double>(course.size());
  }
  const auto [low, high] = std::ranges::minmax_element(course, {}, &std::pair<double, double>::second);
  if (e.over_time == "smallest" || e.over_time == "largest") {
    return e.over_time == "smallest" ? low->second : high->second;
  }
  const auto& farthest = -low->second > high->second ? *low : *high;
  return e.over_time == "farthest" ? farthest.second : farthest.first;
}

double error_of(const Expectation& e, double result) noexcept {
  const double difference = std::abs(result - e.reference);
  return e.reference == 0.0 ? difference : difference / std::abs(e.reference);
}

}  // namespace fexp::io
