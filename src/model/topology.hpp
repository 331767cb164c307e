// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "base/errors.hpp"
#include "base/index.hpp"
#include "model/mesh.hpp"

namespace fexp::model {

using Triangle = std::array<Index, 3>;

/// An edge of a triangle.
struct EdgeUse {
  Index low;     ///< The lower one of its nodes
  Index high;    ///< The higher one
  Index corner;  ///< 3 x triangle + edge

  [[nodiscard]] bool same_edge(const EdgeUse& other) const noexcept { return low == other.low && high == other.high; }
};

/// All edges of all triangles by lower node, higher node and corner.
[[nodiscard]] std::vector<EdgeUse> sorted_edges(std::span<const Triangle> triangles);

/// Calls visit(uses) for each edge with those of the triangles at it, which ascend.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> edges, const Visit& visit) {
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].same_edge(edges[begin])) {
      ++end;
    }
    visit(edges.subspan(begin, end - begin));
    begin = end;
  }
}

/// Element across each edge (corner a to corner a+1) of each triangle, or no_index at free edges and those of more than
/// two triangles, shape [triangles]. The mesh must have passed check_mesh.
[[nodiscard]] std::vector<Triangle> edge_neighbours(std::span<const Triangle> triangles);

/// Nodes on free edges, ascending.
[[nodiscard]] std::vector<Index> boundary_nodes(std::span<const Triangle> triangles);

/// Corners of each node as compressed rows: corner = 3 x triangle + corner, ascending within a node.
struct CornerRows {
  std::vector<Index> start;   // [nodes + 1]
  std::vector<Index> corner;  // [3 x triangles]
};
[[nodiscard]] CornerRows corner_rows(Index nodes, std::span<const Triangle> triangles);

/// A mesh's triangles, turned so that neighbours agree about the side, and the elements across their edges.
struct Surface {
  std::vector<Triangle> triangle;   // [triangles]
  std::vector<Triangle> neighbour;  // [triangles], as from edge_neighbours, and the straightest at branched edges
  bool branched{};                  ///< Some edges have more than two triangles
};

/// Turns the triangle's normal round; its edges change places, and what lies across them too.
void turn(Triangle& triangle, Triangle& neighbours) noexcept;

/// Turns triangles so that neighbours agree about the side their normals point to: the first triangle of each connected
/// piece decides. Returns false when that is impossible (a Moebius strip). `neighbours` are those of edge_neighbours,
/// and stay so.
bool orient_consistently(std::vector<Triangle>& triangles, std::vector<Triangle>& neighbours);

/// Reports what makes a mesh unfit: no triangles, corners out of range or repeated, coordinates that are no finite
/// numbers, areas that are zero against the longest edge, edges of more triangles than most_at_edge, no common side.
/// `body` names the mesh. Returns the surface that the mesh makes; it is empty when something was reported. At an edge
/// of more than two triangles, the two of them that go on most straightly are neighbours and agree about the side,
/// unless that leaves no common side anywhere.
Surface check_mesh(const Mesh& mesh, const Place& place, std::string_view body, ErrorList& errors);

}  // namespace fexp::model
