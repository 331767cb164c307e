// SPDX-License-Identifier: Apache-2.0
#include "app/crossings_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fexp::app {

namespace {

/// Rows of the table; --json has all.
constexpr std::size_t most_table_rows = 40;

std::string place_text(const Vec3d& x) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x, x.y, x.z); }

std::string row_of_table(const ReportedFrame& frame, const PairCrossings& pair) {
  return fmt::format("{:>6} {:>9} {:>13.6g} {:>8} {:>9} {:>7}  {}\n", frame.frame, frame.step, frame.time, pair.edges,
                     pair.edges - pair.edges_at_start, pair.nodes,
                     pair.body == pair.other_body ? fmt::format("\"{}\" and itself", pair.body)
                                                  : fmt::format("\"{}\" and \"{}\"", pair.body, pair.other_body));
}

std::string details_text(const PairCrossings& pair) {
  std::string text;
  for (const ToldCut& cut : pair.first_edges) {
    text += fmt::format("         edge {}-{} of \"{}\" through element {} of \"{}\" at {}{}\n", cut.node,
                        cut.other_node, cut.body, cut.element, cut.element_body, place_text(cut.place),
                        cut.at_start ? ", as at the start" : "");
  }
  for (const ToldNode& node : pair.first_nodes) {
    text += fmt::format("         node {} of \"{}\" has passed through \"{}\" and is at {}\n", node.node, node.body,
                        node.passed, place_text(node.place));
  }
  return text;
}

nlohmann::ordered_json json_array(const Vec3d& x) { return nlohmann::ordered_json::array({x.x, x.y, x.z}); }

nlohmann::ordered_json json_of(const PairCrossings& pair) {
  nlohmann::ordered_json edges = nlohmann::ordered_json::array(), nodes = nlohmann::ordered_json::array();
  for (const ToldCut& cut : pair.first_edges) {
    edges.push_back({{"nodes", {cut.node, cut.other_node}},
                     {"body", cut.body},
                     {"element", cut.element},
                     {"element_body", cut.element_body},
                     {"place", json_array(cut.place)},
                     {"at_start", cut.at_start}});
  }
  for (const ToldNode& node : pair.first_nodes) {
    nodes.push_back(
        {{"node", node.node}, {"body", node.body}, {"passed", node.passed}, {"place", json_array(node.place)}});
  }
  return {{"bodies", {pair.body, pair.other_body}},   {"edges_through_triangles", pair.edges},
          {"of_these_at_start", pair.edges_at_start}, {"nodes_on_the_wrong_side", pair.nodes},
          {"first_edges", std::move(edges)},          {"first_nodes", std::move(nodes)}};
}

}  // namespace

bool CrossingsReport::has_new() const {
  return std::ranges::any_of(
      frames, [](const ReportedFrame& frame) { return std::ranges::any_of(frame.pairs, &PairCrossings::has_new); });
}

std::string CrossingsReport::text() const {
  std::size_t rows = 0, frames_with_new = 0;
  std::string table;
  bool told = false, told_new = false;
  for (const ReportedFrame& frame : frames) {
    frames_with_new += std::ranges::any_of(frame.pairs, &PairCrossings::has_new) ? 1U : 0U;
    for (const PairCrossings& pair : frame.pairs) {
      if (++rows > most_table_rows) {
        continue;
      }
      table += row_of_table(frame, pair);
      // Ids where something is seen for the first time.
      if (!told || (pair.has_new() && !told_new)) {
        table += details_text(pair);
      }
      told = true;
      told_new = told_new || pair.has_new();
    }
  }
  std::string text;
  if (rows > 0) {
    text += fmt::format("{:>6} {:>9} {:>13} {:>8} {:>9} {:>7}  {}\n", "frame", "step", "time", "edges", "new edges",
                        "nodes", "bodies");
    text += table;
    text += rows > most_table_rows ? fmt::format("and {} more rows, which --json lists\n", rows - most_table_rows) : "";
  }
  text += fmt::format("{}: {} frames", results, frames.size());
  if (!frames.empty()) {
    text += fmt::format(", time {:.6g} to {:.6g}", frames.front().time, frames.back().time);
  }
  if (rows == 0) {
    return text + ": nothing crosses\n";
  }
  return text + (frames_with_new == 0 ? ": nothing crosses but what does in the first frame\n"
                                      : fmt::format(": surfaces cross in {} frames\n", frames_with_new));
}

nlohmann::ordered_json to_json(const CrossingsReport& report) {
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (const ReportedFrame& frame : report.frames) {
    nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
    std::int64_t edges = 0, at_start = 0, nodes = 0;
    for (const PairCrossings& pair : frame.pairs) {
      edges += pair.edges;
      at_start += pair.edges_at_start;
      nodes += pair.nodes;
      pairs.push_back(json_of(pair));
    }
    frames.push_back({{"frame", frame.frame},
                      {"step", frame.step},
                      {"time", frame.time},
                      {"edges_through_triangles", edges},
                      {"of_these_at_start", at_start},
                      {"nodes_on_the_wrong_side", nodes},
                      {"pairs", std::move(pairs)}});
  }
  return {{"results", report.results}, {"crosses", report.has_new()}, {"frames", std::move(frames)}};
}

}  // namespace fexp::app
