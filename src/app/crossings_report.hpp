// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace fexp::app {

/// An edge through a triangle, with the user's ids.
struct ToldCut {
  std::int64_t node{};
  std::int64_t other_node{};
  std::string body;  ///< Of the edge
  std::int64_t element{};
  std::string element_body;
  Vec3d place;  ///< Where the edge goes through [length]
  bool at_start{};
};

/// A node behind a surface that it has passed.
struct ToldNode {
  std::int64_t node{};
  std::string body;
  std::string passed;  ///< The body whose surface it is
  Vec3d place;         ///< Of the node [length]
};

/// What crosses between two bodies, or within one, in one frame.
struct PairCrossings {
  std::string body;
  std::string other_body;
  std::int64_t edges{};              ///< Edges through triangles, each pair of both counted
  std::int64_t edges_at_start{};     ///< Those of them that are there in the first frame
  std::int64_t nodes{};              ///< Nodes on the wrong side
  std::vector<ToldCut> first_edges;  ///< The first few, new ones before those of the start
  std::vector<ToldNode> first_nodes;

  [[nodiscard]] bool has_new() const { return edges > edges_at_start || nodes > 0; }
};

struct ReportedFrame {
  std::int64_t frame{};
  std::int64_t step{};
  double time{};
  std::vector<PairCrossings> pairs;  ///< Those in which anything crosses
};

/// What `fexp crossings` tells.
struct CrossingsReport {
  std::string results;  ///< Path
  std::vector<ReportedFrame> frames;

  /// Whether anything crosses that did not in the first frame.
  [[nodiscard]] bool has_new() const;
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] nlohmann::ordered_json to_json(const CrossingsReport& report);

}  // namespace fexp::app
