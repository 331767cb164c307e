// SPDX-License-Identifier: Apache-2.0
#include "io/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "base/hash.hpp"
#include "io/hash_log.hpp"
#include "io/run_directory.hpp"
#include "io/vtkhdf_reader.hpp"

namespace fexp::io {

namespace fs = std::filesystem;

namespace {

/// The parts of a run that are there.
struct Run {
  std::optional<std::vector<HashRow>> hashes;
  std::optional<ResultsReader> results;
};

Run open_run(const fs::path& path) {
  Run run;
  if (!fs::is_directory(path)) {
    run.results.emplace(path);
    return run;
  }
  const RunDirectory directory(path);
  if (fs::exists(directory.hashes())) {
    run.hashes = read_hash_log(directory.hashes());
  }
  if (fs::exists(directory.results())) {
    run.results.emplace(directory.results());
  }
  return run;
}

std::string name_of(const std::vector<std::string>& names, Index body) {
  return body >= 0 && at(body) < names.size() ? names[at(body)] : "";
}

bool before(const HashRow& a, const HashRow& b) { return a.step != b.step ? a.step < b.step : a.body < b.body; }

/// Walks both logs in step. A log may end early, when its run did; entries that only one has are a difference only
/// where both go on.
void compare_hashes(const std::vector<HashRow>& a, const std::vector<HashRow>& b, Comparison& result) {
  const std::size_t common = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (a[i] == b[i]) {
      continue;
    }
    const HashRow& first = before(b[i], a[i]) ? b[i] : a[i];
    const auto shown = [&](const HashRow& row) {
      return row.step == first.step && row.body == first.body ? hash_text(row.hash) : std::string("missing");
    };
    result.hash = HashDifference{first.step, first.body, "", shown(a[i]), shown(b[i])};
    return;
  }
  result.notes.push_back(fmt::format("The first {} entries of the hash logs are the same.", common));
  if (a.size() != b.size()) {
    result.notes.push_back(fmt::format("The hash logs differ in length: {} and {} entries.", a.size(), b.size()));
  }
}

/// First item whose `item_bytes` bytes differ, or no_index.
Index first_difference(const void* a, const void* b, std::size_t items, std::size_t item_bytes) {
  const auto* bytes_a = static_cast<const std::byte*>(a);
  const auto* bytes_b = static_cast<const std::byte*>(b);
  if (std::memcmp(bytes_a, bytes_b, items * item_bytes) == 0) {
    return no_index;
  }
  std::size_t item = 0;
  while (std::memcmp(bytes_a + item * item_bytes, bytes_b + item * item_bytes, item_bytes) == 0) {
    ++item;
  }
  return static_cast<Index>(item);
}

std::vector<double> item_values(const std::vector<double>& all, Index index, std::size_t components) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(at(index) * components);
  return {begin, begin + static_cast<std::ptrdiff_t>(components)};
}

const ResultField& body_field() {
  return *std::ranges::find_if(result_fields(), [](const ResultField& field) { return field.name == "body"; });
}

void name_node(const ResultsReader& run, ValueDifference& d) {
  d.label = run.node_labels()[at(d.index)];
  d.body = run.node_bodies()[at(d.index)];
  d.body_name = name_of(run.body_names(), d.body);
}

void name_element(const ResultsReader& run, ValueDifference& d) {
  d.label = run.element_labels()[at(d.index)];
  d.body = static_cast<Index>(run.numbers(body_field(), 0)[at(d.index)]);
  d.body_name = name_of(run.body_names(), d.body);
}

std::optional<ValueDifference> compare_points(const ResultsReader& a, const ResultsReader& b, std::int64_t frame) {
  const std::vector<double> points_a = a.points(frame);
  const std::vector<double> points_b = b.points(frame);
  ValueDifference d;
  d.index = first_difference(points_a.data(), points_b.data(), at(a.nodes()), 3 * sizeof(double));
  if (d.index == no_index) {
    return std::nullopt;
  }
  d.field = "position";
  d.at_node = true;
  d.a = item_values(points_a, d.index, 3);
  d.b = item_values(points_b, d.index, 3);
  name_node(a, d);
  return d;
}

std::optional<ValueDifference> compare_field(const ResultsReader& a, const ResultsReader& b, const ResultField& field,
                                             std::int64_t frame) {
  const std::vector<std::byte> raw_a = a.raw(field, frame);
  const std::vector<std::byte> raw_b = b.raw(field, frame);
  const std::size_t item_bytes = row_bytes(field);
  ValueDifference d;
  d.index = first_difference(raw_a.data(), raw_b.data(), raw_a.size() / item_bytes, item_bytes);
  if (d.index == no_index) {
    return std::nullopt;
  }
  d.field = field.name;
  d.at_node = field.place == FieldPlace::node;
  d.a = item_values(a.numbers(field, frame), d.index, static_cast<std::size_t>(field.components));
  d.b = item_values(b.numbers(field, frame), d.index, static_cast<std::size_t>(field.components));
  d.at_node ? name_node(a, d) : name_element(a, d);
  return d;
}

/// Positions first, as everything else follows from motion; then the fields in their order.
std::optional<ValueDifference> compare_frame(const ResultsReader& a, const ResultsReader& b, std::int64_t frame) {
  std::optional<ValueDifference> d = compare_points(a, b, frame);
  for (const ResultField& field : result_fields()) {
    if (d || (a.is_constant(field) && b.is_constant(field) && frame > 0)) {
      continue;
    }
    d = compare_field(a, b, field, frame);
  }
  if (d) {
    d->frame = frame;
    d->step = a.steps()[static_cast<std::size_t>(frame)];
    d->time = a.times()[static_cast<std::size_t>(frame)];
  }
  return d;
}

void compare_results(const ResultsReader& a, const ResultsReader& b, Comparison& result) {
  if (a.nodes() != b.nodes() || a.elements() != b.elements() || a.connectivity() != b.connectivity()) {
    result.same = false;
    result.notes.push_back(fmt::format("The models differ: {} nodes and {} elements, and {} nodes and {} elements.",
                                       a.nodes(), a.elements(), b.nodes(), b.elements()));
    return;
  }
  const std::int64_t common = std::min(a.frames(), b.frames());
  for (std::int64_t frame = 0; frame < common; ++frame) {
    const auto i = static_cast<std::size_t>(frame);
    if (a.steps()[i] != b.steps()[i] || a.times()[i] != b.times()[i]) {
      result.same = false;
      result.notes.push_back(
          fmt::format("Frame {} is of step {} at time {} in one run and of step {} at time {} in "
                      "the other.",
                      frame, a.steps()[i], a.times()[i], b.steps()[i], b.times()[i]));
      return;
    }
    result.value = compare_frame(a, b, frame);
    if (result.value) {
      return;
    }
  }
  result.notes.push_back(fmt::format("The first {} frames are the same.", common));
  if (a.frames() != b.frames()) {
    result.notes.push_back(fmt::format("The runs have {} and {} frames.", a.frames(), b.frames()));
  }
}

}  // namespace

std::string Comparison::text() const {
  std::string text = !comparable ? "Nothing to compare.\n" : same ? "The same.\n" : "Different.\n";
  if (hash) {
    const std::string name = hash->body_name.empty() ? "" : fmt::format(" ({})", hash->body_name);
    text += fmt::format("First differing hash: step {}, body {}{}: {} and {}.\n", hash->step, hash->body, name,
                        hash->hash_a, hash->hash_b);
  }
  if (value) {
    text += fmt::format(
        "First differing value: frame {} (step {}, time {}), {} {} (number {}) of body {} ({}), {}: "
        "({}) and ({}).\n",
        value->frame, value->step, value->time, value->at_node ? "node" : "element", value->index, value->label,
        value->body, value->body_name, value->field, fmt::join(value->a, ", "), fmt::join(value->b, ", "));
  }
  for (const std::string& note : notes) {
    text += note + "\n";
  }
  return text;
}

Comparison compare_runs(const fs::path& path_a, const fs::path& path_b) {
  const Run a = open_run(path_a);
  const Run b = open_run(path_b);
  Comparison result;
  result.same = true;
  if (a.hashes && b.hashes) {
    result.comparable = true;
    compare_hashes(*a.hashes, *b.hashes, result);
  } else {
    result.notes.emplace_back("No hash logs in both runs (run with --hash-every to compare each step).");
  }
  if (a.results && b.results) {
    result.comparable = true;
    compare_results(*a.results, *b.results, result);
  } else {
    result.notes.emplace_back("No results files in both runs.");
  }
  if (result.hash && a.results) {
    result.hash->body_name = name_of(a.results->body_names(), result.hash->body);
  }
  result.same = result.comparable && result.same && !result.hash && !result.value;
  return result;
}

}  // namespace fexp::io
