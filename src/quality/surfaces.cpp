// SPDX-License-Identifier: Apache-2.0
#include "quality/surfaces.hpp"

#include <algorithm>
#include <utility>

namespace fexp::quality {

namespace {

std::array<Index, 2> edge_of(const std::array<Index, 3>& triangle, std::size_t corner) {
  const Index a = triangle[corner], b = triangle[(corner + 1) % 3];
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

Surfaces::Surfaces(std::vector<std::array<Index, 3>> triangles, std::vector<Index> bodies_of_nodes, Index bodies)
    : triangle(std::move(triangles)),
      node_body(std::move(bodies_of_nodes)),
      triangle_edges(triangle.size()),
      body_nodes(at(bodies)),
      body_triangles(at(bodies)) {
  edge.reserve(3 * triangle.size());
  for (const auto& t : triangle) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      edge.push_back(edge_of(t, corner));
    }
  }
  std::sort(edge.begin(), edge.end());
  edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
  edge.shrink_to_fit();
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto found = std::lower_bound(edge.begin(), edge.end(), edge_of(triangle[t], corner));
      triangle_edges[t][corner] = static_cast<Index>(found - edge.begin());
    }
    body_triangles[at(body_of_triangle(static_cast<Index>(t)))].push_back(static_cast<Index>(t));
  }
  for (std::size_t n = 0; n < node_body.size(); ++n) {
    body_nodes[at(node_body[n])].push_back(static_cast<Index>(n));
  }
}

}  // namespace fexp::quality
