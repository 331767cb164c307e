// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/index.hpp"

namespace fexp::quality {

/// The triangles of all bodies, as results have them, with what is looked up in them.
class Surfaces {
 public:
  /// `bodies_of_nodes` has shape [nodes], with bodies of [0, `bodies`). A triangle's nodes are of one body.
  Surfaces(std::vector<std::array<Index, 3>> triangles, std::vector<Index> bodies_of_nodes, Index bodies);

  [[nodiscard]] Index bodies() const noexcept { return static_cast<Index>(body_nodes.size()); }
  [[nodiscard]] Index nodes() const noexcept { return static_cast<Index>(node_body.size()); }
  [[nodiscard]] Index body_of_triangle(Index t) const { return node_body[at(triangle[at(t)][0])]; }

  std::vector<std::array<Index, 3>> triangle;        ///< Its nodes
  std::vector<Index> node_body;                      ///< [nodes]
  std::vector<std::array<Index, 2>> edge;            ///< Its nodes, the lower first; ascending, each once
  std::vector<std::array<Index, 3>> triangle_edges;  ///< [triangles]; edge i begins at corner i
  std::vector<std::vector<Index>> body_nodes;        ///< [bodies], ascending
  std::vector<std::vector<Index>> body_triangles;    ///< [bodies], ascending
};

}  // namespace fexp::quality
