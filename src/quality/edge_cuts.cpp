// SPDX-License-Identifier: Apache-2.0
#include "quality/edge_cuts.hpp"

#include <algorithm>
#include <cmath>

#include "base/orientation.hpp"
#include "contact/box_tree.hpp"
#include "parallel/parallel.hpp"

namespace fexp::quality {

namespace {

constexpr Index edges_in_a_piece = 8192;

/// Whether a plane through an edge of the triangle and across it has the segment clearly on its outer side. This
/// spares the exact signs where neighbours lie in one plane.
bool is_clearly_beside(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d inward = cross(normal, t[(i + 1) % 3] - t[i]);
    // Far more than the errors of rounding, and little against a triangle.
    const double margin = 1e-9 * norm(inward) * (norm(p - t[i]) + norm(q - t[i]) + norm(t[(i + 1) % 3] - t[i]));
    if (dot(inward, p - t[i]) < -margin && dot(inward, q - t[i]) < -margin) {
      return true;
    }
  }
  return false;
}

bool has_node(const std::array<Index, 3>& triangle, Index node) {
  return triangle[0] == node || triangle[1] == node || triangle[2] == node;
}

}  // namespace

bool goes_through(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  if (is_clearly_beside(p, q, t) || orientation(t[0], t[1], t[2], p) * orientation(t[0], t[1], t[2], q) != -1) {
    return false;
  }
  const int a = orientation(p, q, t[0], t[1]), b = orientation(p, q, t[1], t[2]), c = orientation(p, q, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

std::vector<EdgeCut> find_edge_cuts(const Surfaces& surfaces, std::span<const Vec3d> position,
                                    std::span<const char> alive) {
  const auto corners = [&](Index t) {
    const auto& nodes = surfaces.triangle[at(t)];
    return std::array{position[at(nodes[0])], position[at(nodes[1])], position[at(nodes[2])]};
  };
  std::vector<Box> boxes(surfaces.triangle.size());
  std::vector<char> edge_alive(surfaces.edge.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    if (alive[t] != 0) {
      for (std::size_t i = 0; i < 3; ++i) {
        boxes[t].include(position[at(surfaces.triangle[t][i])]);
        edge_alive[at(surfaces.triangle_edges[t][i])] = 1;
      }
    }
  }
  contact::BoxTree tree;
  tree.build(boxes);
  const auto cuts_of_edges = [&](Index begin, Index end) {
    std::vector<EdgeCut> cuts;
    for (Index e = begin; e < end; ++e) {
      if (edge_alive[at(e)] == 0) {
        continue;
      }
      const auto& nodes = surfaces.edge[at(e)];
      const Vec3d &p = position[at(nodes[0])], &q = position[at(nodes[1])];
      Box box;
      box.include(p);
      box.include(q);
      tree.query(box, [&](Index t) {
        const auto& triangle = surfaces.triangle[at(t)];
        if (!has_node(triangle, nodes[0]) && !has_node(triangle, nodes[1]) && goes_through(p, q, corners(t))) {
          cuts.push_back({e, t});
        }
      });
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  };
  const auto append = [](std::vector<EdgeCut> all, const std::vector<EdgeCut>& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  return parallel::ordered_fold({0, static_cast<Index>(surfaces.edge.size())}, edges_in_a_piece, std::vector<EdgeCut>{},
                                cuts_of_edges, append);
}

}  // namespace fexp::quality
