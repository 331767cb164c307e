// SPDX-License-Identifier: Apache-2.0
#include "app/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/convergence.hpp"

namespace fexp::app {

namespace {

io::MeshResult mesh_result(const VerifyRow& row) { return {row.factor, row.result}; }

nlohmann::ordered_json optional_json(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json verified_row(const VerifyRow& row) {
  const io::Expectation& e = row.expected;
  nlohmann::ordered_json json{{"case", row.name},
                              {"deck", row.deck},
                              {"title", row.title},
                              {"elements", row.elements},
                              {"factor", row.factor},
                              {"quantity", e.name},
                              {"reference", e.reference},
                              {"source", e.source},
                              {"result", row.result},
                              {"error", row.error},
                              {"relative", e.reference != 0.0}};
  json["tolerance"] = row.is_held() ? nlohmann::ordered_json(e.tolerance) : nlohmann::ordered_json(nullptr);
  json["good"] = !row.is_wrong();
  return json;
}

nlohmann::ordered_json verified_series(const VerifySeries& series) {
  const io::Expectation& e = series.expected();
  nlohmann::ordered_json meshes = nlohmann::ordered_json::array();
  for (const VerifyRow& row : series.rows) {
    meshes.push_back(
        {{"factor", row.factor}, {"elements", row.elements}, {"result", row.result}, {"error", row.error}});
  }
  return {
      {"case", series.rows.front().name},
      {"quantity", e.name},
      {"reference", e.reference},
      {"exact", e.exact},
      {"meshes", std::move(meshes)},
      {"order", optional_json(series.order)},
      {"limit", optional_json(series.limit)},
      {"least_order", e.least_order < 0.0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(e.least_order)},
      {"good", !series.is_wrong()}};
}

std::string_view verdict(bool wrong) { return wrong ? "WRONG" : "ok"; }

}  // namespace

std::int64_t VerifyFindings::held() const {
  return std::ranges::count_if(rows, &VerifyRow::is_held) +
         std::ranges::count_if(series, [](const VerifySeries& s) { return s.expected().least_order >= 0.0; });
}

std::int64_t VerifyFindings::wrong() const {
  return std::ranges::count_if(rows, &VerifyRow::is_wrong) + std::ranges::count_if(series, &VerifySeries::is_wrong);
}

std::vector<VerifySeries> series_of(const std::vector<VerifyRow>& rows) {
  std::vector<VerifySeries> all;
  for (const VerifyRow& row : rows) {
    if (!io::in_series(row.expected)) {
      continue;
    }
    const auto same = std::ranges::find_if(
        all, [&](const VerifySeries& s) { return s.expected().place.line == row.expected.place.line; });
    (same == all.end() ? all.emplace_back() : *same).rows.push_back(row);
  }
  std::erase_if(all, [](const VerifySeries& s) { return s.rows.size() < 2; });
  for (VerifySeries& series : all) {
    const std::vector<VerifyRow>& r = series.rows;
    const std::size_t n = r.size();
    if (series.expected().exact) {
      series.order = io::order_towards(series.expected().reference, mesh_result(r[n - 2]), mesh_result(r[n - 1]));
    } else if (n >= 3) {
      if (const auto found = io::extrapolate({mesh_result(r[n - 3]), mesh_result(r[n - 2]), mesh_result(r[n - 1])})) {
        series.order = found->order;
        series.limit = found->limit;
      }
    }
  }
  return all;
}

std::string head_text(std::size_t width) {
  return fmt::format("{:<{}} {:>8}  {:<52} {:>12} {:>12} {:>9} {:>9}  {:<6} {}\n", "case", width, "elements",
                     "quantity", "reference", "result", "error", "tolerance", "", "source");
}

std::string row_text(const VerifyRow& row, std::size_t width) {
  const io::Expectation& e = row.expected;
  return fmt::format("{:<{}} {:>8}  {:<52} {:>12.6g} {:>12.6g} {:>9.2e} {:>9}  {:<6} {}\n", row.name, width,
                     row.elements, e.name, e.reference, row.result, row.error,
                     row.is_held() ? fmt::format("{:.1e}", e.tolerance) : "-",
                     row.is_held() ? verdict(row.is_wrong()) : "-", e.source);
}

std::string series_text(const VerifySeries& series, std::size_t width) {
  const io::Expectation& e = series.expected();
  std::string text = fmt::format("{:<{}} {:>8}  {:<52} ", series.rows.front().name, width, "refined", e.name);
  if (!series.order) {
    text += "no order observed";
  } else if (series.limit) {
    text += fmt::format("order {:.2f} on the three finest meshes, limit {:.6g}", *series.order, *series.limit);
  } else {
    text += fmt::format("order {:.2f} towards the reference", *series.order);
  }
  if (e.least_order >= 0.0) {
    text += fmt::format(", at least {:g} expected: {}", e.least_order, verdict(series.is_wrong()));
  }
  return text + "\n";
}

std::string sum_text(const VerifyFindings& findings) {
  return fmt::format("{} of {} results are as expected{}\n", findings.held() - findings.wrong(), findings.held(),
                     findings.stopped.empty() ? "" : fmt::format("; {} runs stopped", findings.stopped.size()));
}

nlohmann::ordered_json to_json(const VerifyFindings& findings) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array(), series = nlohmann::ordered_json::array();
  std::ranges::transform(findings.rows, std::back_inserter(rows), verified_row);
  std::ranges::transform(findings.series, std::back_inserter(series), verified_series);
  return {{"rows", std::move(rows)},
          {"series", std::move(series)},
          {"wrong", findings.wrong()},
          {"stopped", findings.stopped}};
}

}  // namespace fexp::app
