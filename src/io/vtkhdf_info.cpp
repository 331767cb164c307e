// SPDX-License-Identifier: Apache-2.0
#include "io/vtkhdf_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/vtkhdf_reader.hpp"

namespace fexp::io {

namespace fs = std::filesystem;

namespace {

void include(const std::vector<double>& values, FieldRange& range) {
  for (const double value : values) {
    if (std::isfinite(value)) {
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    } else {
      ++range.not_finite;
    }
  }
}

FieldRange empty_range(std::string name, std::string unit, std::string meaning, bool at_node, int components) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {std::move(name), std::move(unit), std::move(meaning), at_node, components, infinity, -infinity, 0};
}

std::vector<FieldRange> ranges(const ResultsReader& reader) {
  std::vector<FieldRange> result;
  if (reader.frames() == 0) {
    return result;
  }
  result.push_back(empty_range("position", "length", "Position of the nodes", true, 3));
  for (std::int64_t frame = 0; frame < reader.frames(); ++frame) {
    include(reader.points(frame), result.back());
  }
  for (const ResultField& field : result_fields()) {
    result.push_back(empty_range(std::string(field.name), std::string(field.unit), std::string(field.meaning),
                                 field.place == FieldPlace::node, field.components));
    const std::int64_t frames = reader.is_constant(field) ? 1 : reader.frames();
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      include(reader.numbers(field, frame), result.back());
    }
  }
  return result;
}

std::string completeness_of(const RunDirectory& run) {
  std::error_code error;
  if (!fs::exists(run.summary(), error)) {
    return "unfinished: the run goes on or was killed";
  }
  const auto json = nlohmann::json::parse(read_whole(run.summary()), nullptr, false);
  if (!json.is_object()) {
    return "unknown: summary.json cannot be read";
  }
  if (json.value("completed", false)) {
    return "complete";
  }
  const std::string message = json.value("message", "");
  return "ended early: " + (message.empty() ? json.value("exit_reason", "no reason given") : message);
}

std::vector<std::string> histories_in(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == ".csv") {
      names.push_back(entry.path().filename().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string file_size(std::uintmax_t bytes) {
  constexpr double mega = 1.0e6;
  return bytes < 1000000 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} MB", static_cast<double>(bytes) / mega);
}

}  // namespace

ResultsInfo read_info(const fs::path& path) {
  ResultsInfo info;
  std::error_code error;
  const bool directory = fs::is_directory(path, error);
  info.results = directory ? RunDirectory(path).results() : path;
  const ResultsReader reader(info.results);
  info.title = reader.title();
  info.program = reader.program();
  info.nodes = reader.nodes();
  info.elements = reader.elements();
  info.bodies = reader.body_names();
  info.times = reader.times();
  info.steps = reader.steps();
  info.fields = ranges(reader);
  info.bytes = fs::file_size(info.results, error);
  info.completeness = directory ? completeness_of(RunDirectory(path)) : "unknown";
  if (directory) {
    info.histories = histories_in(path);
  }
  return info;
}

std::string ResultsInfo::text() const {
  std::string text = fmt::format("{}: {}\n", results.string(), title.empty() ? "no title" : title);
  text += fmt::format("written by {}, {}, {}\n", program, file_size(bytes), completeness);
  text += fmt::format("{} elements, {} nodes, {} bodies, {} frames", elements, nodes, bodies.size(), times.size());
  if (!times.empty()) {
    text += fmt::format(", step {} to {}, time {} to {}", steps.front(), steps.back(), times.front(), times.back());
  }
  text += "\n";
  for (const FieldRange& field : fields) {
    const std::string kind = fmt::format("{} x {}", field.at_node ? "nodes" : "elements", field.components);
    text +=
        fmt::format("  {:<17} {:<13} {:>13.6g} to {:<13.6g} [{}]", field.name, kind, field.low, field.high, field.unit);
    text += field.not_finite > 0 ? fmt::format(" {} values are not finite\n", field.not_finite) : "\n";
  }
  if (!histories.empty()) {
    text += fmt::format("histories:");
    for (const std::string& name : histories) {
      text += " " + name;
    }
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json to_json(const ResultsInfo& info) {
  nlohmann::ordered_json fields = nlohmann::ordered_json::object();
  for (const FieldRange& field : info.fields) {
    fields[field.name] = {{"unit", field.unit},
                          {"meaning", field.meaning},
                          {"place", field.at_node ? "node" : "element"},
                          {"components", field.components},
                          {"low", field.low},
                          {"high", field.high},
                          {"not_finite", field.not_finite}};
  }
  return {{"results", info.results.string()},
          {"title", info.title},
          {"program", info.program},
          {"completeness", info.completeness},
          {"bytes", info.bytes},
          {"nodes", info.nodes},
          {"elements", info.elements},
          {"bodies", info.bodies},
          {"frames", info.times.size()},
          {"times", info.times},
          {"steps", info.steps},
          {"fields", std::move(fields)},
          {"histories", info.histories}};
}

}  // namespace fexp::io
