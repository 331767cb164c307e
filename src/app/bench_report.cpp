// SPDX-License-Identifier: Apache-2.0
#include "app/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace fexp::app {

namespace {

using nlohmann::ordered_json;

/// Columns of the table: the keys of rows as JSON has them, with their units.
const std::vector<io::Column>& columns() {
  static const std::vector<io::Column> all{{"case", ""},
                                           {"elements", ""},
                                           {"nodes", ""},
                                           {"threads", ""},
                                           {"repetitions", ""},
                                           {"element_steps_per_second", "1/s"},
                                           {"spread", "-"},
                                           {"nanoseconds_per_element_step", "ns"},
                                           {"microseconds_per_step", "us"},
                                           {"steps", ""},
                                           {"islands", ""},
                                           {"active_pairs", ""},
                                           {"searches_per_step", ""},
                                           {"contact_share", "-"},
                                           {"flops_per_element_step", "flop"},
                                           {"bytes_per_element_step", "byte"},
                                           {"triad_bandwidth", "byte/s"},
                                           {"peak_flops", "flop/s"},
                                           {"separate_peak_flops", "flop/s"},
                                           {"share_of_triad_bandwidth", "-"},
                                           {"share_of_peak_flops", "-"},
                                           {"share_of_separate_peak_flops", "-"},
                                           {"heap_bytes_per_element", "byte"},
                                           {"least_bytes_per_element", "byte"},
                                           {"tree_elements_per_second", "1/s"},
                                           {"tree_spread", "-"},
                                           {"search_elements_per_second", "1/s"},
                                           {"search_spread", "-"}};
  return all;
}

/// What a row is to what the hardware would allow.
struct Shares {
  double triad;     // [-]
  double peak;      // [-]
  double separate;  // [-]
};

Shares shares_of(const bench::StepRow& row, const bench::Roofs& roofs) {
  const double flops = row.cost.flops() * row.element_steps.median;
  return {row.cost.least_bytes() * row.element_steps.median / roofs.triad.best, flops / roofs.peak_flops(),
          flops / roofs.separate.best};
}

ordered_json roofs_json(const bench::Roofs& roofs) {
  return {{"threads", roofs.threads},
          {"triad_bandwidth", roofs.triad.best},
          {"triad_spread", roofs.triad.spread},
          {"peak_flops", roofs.peak_flops()},
          {"fused_peak_flops", roofs.fused.best},
          {"fused_spread", roofs.fused.spread},
          {"separate_peak_flops", roofs.separate.best},
          {"separate_spread", roofs.separate.spread}};
}

ordered_json machine_json(const BenchMachine& machine) {
  ordered_json by_threads = ordered_json::array();
  for (const bench::Roofs& roofs : machine.roofs) {
    by_threads.push_back(roofs_json(roofs));
  }
  const bench::Roofs& most = machine.most();
  return {{"processor", machine.processor},
          {"hardware_threads", machine.hardware_threads},
          {"instruction_set", machine.instruction_set},
          {"cache_bytes", machine.cache_bytes},
          {"triad_array_bytes", machine.array_bytes},
          {"triad_bandwidth", most.triad.best},
          {"peak_flops", most.peak_flops()},
          {"separate_peak_flops", most.separate.best},
          {"by_threads", std::move(by_threads)}};
}

ordered_json count_json(const bench::OperationCount& count) {
  return {{"additions", count.additions},
          {"multiplications", count.multiplications},
          {"divisions", count.divisions},
          {"square_roots", count.square_roots},
          {"flops", count.flops()}};
}

ordered_json row_json(const BenchMachine& machine, const bench::StepRow& row) {
  const bench::Roofs& roofs = machine.roofs_of(row.threads);
  const Shares shares = shares_of(row, roofs);
  const double elements = row.elements, rate = row.element_steps.median;
  return {{"case", row.name},
          {"elements", row.elements},
          {"nodes", row.nodes},
          {"threads", row.threads},
          {"repetitions", bench::repetitions},
          {"element_steps_per_second", rate},
          {"spread", row.element_steps.spread},
          {"nanoseconds_per_element_step", 1.0e9 / rate},
          {"microseconds_per_step", 1.0e6 * elements / rate},
          {"steps", row.steps},
          {"islands", row.islands},
          {"active_pairs", row.active_pairs},
          {"searches_per_step", row.searches},
          {"contact_share", row.contact_share ? ordered_json(*row.contact_share) : ordered_json()},
          {"flops_per_element_step", row.cost.flops()},
          {"bytes_per_element_step", row.cost.least_bytes()},
          {"triad_bandwidth", roofs.triad.best},
          {"peak_flops", roofs.peak_flops()},
          {"separate_peak_flops", roofs.separate.best},
          {"share_of_triad_bandwidth", shares.triad},
          {"share_of_peak_flops", shares.peak},
          {"share_of_separate_peak_flops", shares.separate},
          {"heap_bytes_per_element", row.heap_bytes / elements},
          {"least_bytes_per_element", row.cost.least_memory()}};
}

ordered_json row_json(const BenchMachine& machine, const bench::SearchRow& row) {
  const bench::Roofs& roofs = machine.roofs_of(row.threads);
  return {{"case", row.name},
          {"elements", row.elements},
          {"nodes", row.nodes},
          {"threads", row.threads},
          {"repetitions", bench::repetitions},
          {"tree_elements_per_second", row.trees.median},
          {"tree_spread", row.trees.spread},
          {"search_elements_per_second", row.searches.median},
          {"search_spread", row.searches.spread},
          {"triad_bandwidth", roofs.triad.best},
          {"peak_flops", roofs.peak_flops()}};
}

using Line = std::vector<std::string>;

/// The first column to the left, all others to the right.
std::string aligned(const std::vector<Line>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], line[i].size());
    }
  }
  std::string text;
  for (const Line& line : lines) {
    text += fmt::format("  {:<{}}", line.front(), widths.front());
    for (std::size_t i = 1; i < line.size(); ++i) {
      text += fmt::format("  {:>{}}", line[i], widths[i]);
    }
    text += "\n";
  }
  return text;
}

std::string percent(double part) { return fmt::format("{:.1f} %", 100.0 * part); }

std::string machine_text(const BenchMachine& machine) {
  std::string text = fmt::format("{}, {} hardware threads, kernel {}\n", machine.processor, machine.hardware_threads,
                                 machine.instruction_set);
  std::vector<Line> lines{{"threads", "triad [GB/s]", "fused peak [Gflop/s]", "separate peak [Gflop/s]", "spread"}};
  for (const bench::Roofs& roofs : machine.roofs) {
    const double spread = std::max({roofs.triad.spread, roofs.fused.spread, roofs.separate.spread});
    lines.push_back({std::to_string(roofs.threads), fmt::format("{:.1f}", 1.0e-9 * roofs.triad.best),
                     roofs.fused.best > 0.0 ? fmt::format("{:.1f}", 1.0e-9 * roofs.fused.best) : "none",
                     fmt::format("{:.1f}", 1.0e-9 * roofs.separate.best), percent(spread)});
  }
  return text + aligned(lines) +
         fmt::format(
             "  triad: a[i] = b[i] + s c[i] of arrays of {:.0f} MB, 24 bytes an element; fused: multiply-adds, which "
             "the solver\n  does not use, so that its results are the same everywhere; separate: as many "
             "multiplications as additions\n\n",
             1.0e-6 * machine.array_bytes);
}

std::string steps_text(const BenchMachine& machine, const std::vector<bench::StepRow>& rows) {
  if (rows.empty()) {
    return "";
  }
  std::vector<Line> lines{{"case", "triangles", "threads", "10^6 el-steps/s", "spread", "ns/el-step", "us/step",
                           "of fused peak", "of separate", "of triad", "bytes/el (least)"}};
  std::string contact;
  for (const bench::StepRow& row : rows) {
    const Shares shares = shares_of(row, machine.roofs_of(row.threads));
    const double rate = row.element_steps.median;
    lines.push_back({row.name, std::to_string(row.elements), std::to_string(row.threads),
                     fmt::format("{:.2f}", 1.0e-6 * rate), percent(row.element_steps.spread),
                     fmt::format("{:.1f}", 1.0e9 / rate), fmt::format("{:.1f}", 1.0e6 * row.elements / rate),
                     percent(shares.peak), percent(shares.separate), percent(shares.triad),
                     fmt::format("{:.0f} ({:.0f})", row.heap_bytes / row.elements, row.cost.least_memory())});
    if (row.contact_share) {
      contact += fmt::format("  {}, {}: contact takes {} of a step\n", row.name, threads_text(row.threads),
                             percent(*row.contact_share));
    }
  }
  const bench::ElementStepCost& cost = rows.front().cost;
  return aligned(lines) + contact +
         fmt::format(
             "  an element-step has {} flops, and {} for each of its {:.2f} nodes: {:.0f}; it moves {:.0f} bytes at "
             "the "
             "least where\n  nothing stays in a cache, so that more than 100 % of the triad says that much does; what "
             "contact does is in neither\n\n",
             cost.element.flops(), cost.node.flops(), cost.nodes, cost.flops(), cost.least_bytes());
}

std::string searches_text(const std::vector<bench::SearchRow>& rows) {
  if (rows.empty()) {
    return "";
  }
  std::vector<Line> lines{
      {"case", "triangles", "threads", "10^6 el/s in trees", "spread", "10^6 el/s in searches", "spread"}};
  for (const bench::SearchRow& row : rows) {
    lines.push_back({row.name, std::to_string(row.elements), std::to_string(row.threads),
                     fmt::format("{:.2f}", 1.0e-6 * row.trees.median), percent(row.trees.spread),
                     fmt::format("{:.2f}", 1.0e-6 * row.searches.median), percent(row.searches.spread)});
  }
  return aligned(lines);
}

}  // namespace

const bench::Roofs& BenchMachine::roofs_of(int threads) const {
  return *std::ranges::find(roofs, threads, &bench::Roofs::threads);
}

const bench::Roofs& BenchMachine::most() const { return *std::ranges::max_element(roofs, {}, &bench::Roofs::threads); }

std::string BenchReport::text() const {
  return machine_text(machine) + steps_text(machine, steps) + searches_text(searches);
}

ordered_json BenchReport::json() const {
  ordered_json rows = ordered_json::array(), search_rows = ordered_json::array();
  for (const bench::StepRow& row : steps) {
    rows.push_back(row_json(machine, row));
  }
  for (const bench::SearchRow& row : searches) {
    search_rows.push_back(row_json(machine, row));
  }
  ordered_json whole{{"machine", machine_json(machine)}};
  if (!steps.empty()) {
    whole["element_step"] = {{"element", count_json(steps.front().cost.element)},
                             {"node", count_json(steps.front().cost.node)}};
  }
  whole["rows"] = std::move(rows);
  whole["searches"] = std::move(search_rows);
  return whole;
}

std::string threads_text(int threads) { return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"); }

BenchTable::BenchTable(const std::filesystem::path& path) : csv_(path, columns()) { csv_.flush(); }

void BenchTable::add(const BenchMachine& machine, const bench::StepRow& row) { add(row_json(machine, row)); }
void BenchTable::add(const BenchMachine& machine, const bench::SearchRow& row) { add(row_json(machine, row)); }

void BenchTable::add(const ordered_json& row) {
  std::vector<io::Cell> cells;
  for (const io::Column& column : columns()) {
    const auto found = row.find(column.name);
    if (found == row.end() || found->is_null()) {
      cells.emplace_back(std::string_view());
    } else if (found->is_string()) {
      cells.emplace_back(std::string_view(found->get_ref<const std::string&>()));
    } else if (found->is_number_integer()) {
      cells.emplace_back(found->get<std::int64_t>());
    } else {
      cells.emplace_back(found->get<double>());
    }
  }
  csv_.row(cells);
  csv_.flush();
}

}  // namespace fexp::app
