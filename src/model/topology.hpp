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

/// Element across each edge (corner a to corner a+1) of each triangle, or no_index at free edges, shape [triangles].
/// The mesh must have passed check_mesh.
[[nodiscard]] std::vector<Triangle> edge_neighbours(std::span<const Triangle> triangles);

/// Nodes on free edges, ascending.
[[nodiscard]] std::vector<Index> boundary_nodes(std::span<const Triangle> triangles,
                                                std::span<const Triangle> neighbours);

/// Corners of each node as compressed rows: corner = 3 x triangle + corner, ascending within a node.
struct CornerRows {
  std::vector<Index> start;   // [nodes + 1]
  std::vector<Index> corner;  // [3 x triangles]
};
[[nodiscard]] CornerRows corner_rows(Index nodes, std::span<const Triangle> triangles);

/// A mesh's triangles, turned so that neighbours agree about the side, and the elements across their edges.
struct Surface {
  std::vector<Triangle> triangle;   // [triangles]
  std::vector<Triangle> neighbour;  // [triangles], as from edge_neighbours
};

/// Turns the triangle's normal round; its edges change places, and what lies across them too.
void turn(Triangle& triangle, Triangle& neighbours) noexcept;

/// Turns triangles so that neighbours agree about the side their normals point to: the first triangle of each connected
/// piece decides. Returns false when that is impossible (a Moebius strip). Edges must have at most two triangles;
/// `neighbours` are those of edge_neighbours, and stay so.
bool orient_consistently(std::vector<Triangle>& triangles, std::vector<Triangle>& neighbours);

/// Reports what makes a mesh unfit: no triangles, corners out of range or repeated, coordinates that are no finite
/// numbers, areas that are zero against the longest edge, edges of more than two triangles, no common side. `body`
/// names the mesh. Returns the surface that the mesh makes; it is empty when something was reported.
Surface check_mesh(const Mesh& mesh, const Place& place, std::string_view body, ErrorList& errors);

}  // namespace fexp::model
