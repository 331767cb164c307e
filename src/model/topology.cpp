// SPDX-License-Identifier: Apache-2.0
#include "model/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace fexp::model {

namespace {

/// An edge of a triangle, sortable by its nodes.
struct EdgeUse {
  std::uint64_t key;  ///< Lower node in the high half, higher node in the low half.
  Index corner;       ///< 3 x triangle + edge

  friend bool operator<(const EdgeUse& a, const EdgeUse& b) noexcept {
    return a.key != b.key ? a.key < b.key : a.corner < b.corner;
  }
};

std::vector<EdgeUse> sorted_edges(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto a = static_cast<std::uint64_t>(triangles[t][e]);
      const auto b = static_cast<std::uint64_t>(triangles[t][(e + 1) % 3]);
      edges.push_back({std::min(a, b) << 32U | std::max(a, b), static_cast<Index>(3 * t + e)});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::string triangle_name(const Mesh& mesh, std::size_t t) {
  return mesh.triangle_label.empty() ? std::to_string(t) : std::to_string(mesh.triangle_label[t]);
}

/// At most this many culprits of a kind are named; the rest is counted.
constexpr std::size_t most_named = 5;

std::string named(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > most_named) {
    text += fmt::format(" and {} more", names.size() - most_named);
  }
  return text;
}

constexpr double least_area_ratio = 1.0e-10;

bool is_degenerate(const Mesh& mesh, const Triangle& t) {
  const Vec3d &a = mesh.position[at(t[0])], &b = mesh.position[at(t[1])], &c = mesh.position[at(t[2])];
  const double longest2 = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return !(0.5 * norm(cross(b - a, c - a)) > least_area_ratio * longest2);
}

/// Whether coordinates are finite numbers and corners name nodes; what follows relies on both.
template <class Add>
bool numbers_make_sense(const Mesh& mesh, const Add& add) {
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const Vec3d& x = mesh.position[n];
    if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z)) {
      add(fmt::format("node {} stands at ({}, {}, {})",
                      mesh.node_label.empty() ? std::to_string(n) : std::to_string(mesh.node_label[n]), x.x, x.y, x.z),
          "finite coordinates", "repair the mesh file");
      return false;
    }
  }
  const auto nodes = static_cast<Index>(mesh.position.size());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (const Index n : mesh.triangle[t]) {
      if (n < 0 || n >= nodes) {
        add(fmt::format("triangle {} names a node that is not there", triangle_name(mesh, t)), "nodes of the mesh",
            "repair the mesh file");
        return false;
      }
    }
  }
  return true;
}

/// Pairs of triangles that have all three nodes in common.
std::vector<std::string> duplicate_triangles(const Mesh& mesh, const std::vector<EdgeUse>& edges) {
  const auto opposite = [&](Index corner) { return mesh.triangle[at(corner / 3)][at((corner + 2) % 3)]; };
  std::vector<std::string> names;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Index a = edges[i].corner, b = edges[i + 1].corner;
    // Such a pair meets at three edges; it is named at the first triangle's first edge.
    if (edges[i].key == edges[i + 1].key && a % 3 == 0 && a / 3 != b / 3 && opposite(a) == opposite(b)) {
      names.push_back(fmt::format("{} = {}", triangle_name(mesh, at(a / 3)), triangle_name(mesh, at(b / 3))));
    }
  }
  return names;
}

/// Edges of more than two triangles, by the first three of them.
std::vector<std::string> crowded_edges(const Mesh& mesh, const std::vector<EdgeUse>& edges) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i + 2 < edges.size(); ++i) {
    if (edges[i].key == edges[i + 2].key && (i == 0 || edges[i - 1].key != edges[i].key)) {
      names.push_back(fmt::format("{}-{}-{}", triangle_name(mesh, at(edges[i].corner / 3)),
                                  triangle_name(mesh, at(edges[i + 1].corner / 3)),
                                  triangle_name(mesh, at(edges[i + 2].corner / 3))));
    }
  }
  return names;
}

}  // namespace

std::vector<Triangle> edge_neighbours(std::span<const Triangle> triangles) {
  std::vector<Triangle> neighbours(triangles.size(), {no_index, no_index, no_index});
  const std::vector<EdgeUse> edges = sorted_edges(triangles);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i].key == edges[i + 1].key) {
      const Index a = edges[i].corner, b = edges[i + 1].corner;
      neighbours[at(a / 3)][at(a % 3)] = b / 3;
      neighbours[at(b / 3)][at(b % 3)] = a / 3;
    }
  }
  return neighbours;
}

std::vector<Index> boundary_nodes(std::span<const Triangle> triangles, std::span<const Triangle> neighbours) {
  std::vector<Index> nodes;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (neighbours[t][e] == no_index) {
        nodes.push_back(triangles[t][e]);
        nodes.push_back(triangles[t][(e + 1) % 3]);
      }
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

CornerRows corner_rows(Index nodes, std::span<const Triangle> triangles) {
  CornerRows rows;
  rows.start.assign(at(nodes) + 1, 0);
  for (const Triangle& t : triangles) {
    for (const Index n : t) {
      ++rows.start[at(n) + 1];
    }
  }
  for (std::size_t n = 0; n < at(nodes); ++n) {
    rows.start[n + 1] += rows.start[n];
  }
  rows.corner.resize(3 * triangles.size());
  std::vector<Index> next(rows.start.begin(), rows.start.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      rows.corner[at(next[at(triangles[t][c])]++)] = static_cast<Index>(3 * t + c);
    }
  }
  return rows;
}

bool orient_consistently(std::vector<Triangle>& triangles) {
  const std::vector<Triangle> neighbours = edge_neighbours(triangles);
  std::vector<char> seen(triangles.size(), 0);
  std::vector<std::size_t> stack;
  const auto uses_edge_forwards = [&](std::size_t t, Index a, Index b) {
    for (std::size_t e = 0; e < 3; ++e) {
      if (triangles[t][e] == a && triangles[t][(e + 1) % 3] == b) {
        return true;
      }
    }
    return false;
  };
  // Neighbours are found by edge, and turning a triangle reorders its edges, so they are looked up by node pair.
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (seen[seed] != 0) {
      continue;
    }
    seen[seed] = 1;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::size_t t = stack.back();
      stack.pop_back();
      for (const Index other : neighbours[t]) {
        if (other == no_index) {
          continue;
        }
        const std::size_t o = at(other);
        for (std::size_t e = 0; e < 3; ++e) {
          const Index a = triangles[t][e], b = triangles[t][(e + 1) % 3];
          const bool same = uses_edge_forwards(o, a, b);
          if (!same) {
            continue;
          }
          if (seen[o] != 0) {
            return false;
          }
          std::swap(triangles[o][1], triangles[o][2]);
        }
        if (seen[o] == 0) {
          seen[o] = 1;
          stack.push_back(o);
        }
      }
    }
  }
  return true;
}

void check_mesh(const Mesh& mesh, const Place& place, std::string_view body, ErrorList& errors) {
  const auto add = [&](std::string message, std::string accepted, std::string cure) {
    errors.add(place, fmt::format("mesh of body \"{}\": {}", body, message), std::move(accepted), std::move(cure));
  };
  if (mesh.triangle.empty()) {
    add("it has no triangles", "at least one triangle", "export surface triangles, not only points or lines");
    return;
  }
  const std::size_t before = errors.size();
  if (!numbers_make_sense(mesh, add)) {
    return;
  }
  std::vector<std::string> repeated, degenerate;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const Triangle& n = mesh.triangle[t];
    if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) {
      repeated.push_back(triangle_name(mesh, t));
    } else if (is_degenerate(mesh, n)) {
      degenerate.push_back(triangle_name(mesh, t));
    }
  }
  if (!degenerate.empty()) {
    add(fmt::format("{} degenerate triangle(s) without area: {}", degenerate.size(), named(degenerate)),
        "area > 1e-10 of the longest edge squared", "remove or remesh them");
  }
  if (!repeated.empty()) {
    add(fmt::format("{} degenerate triangle(s) with a repeated node: {}", repeated.size(), named(repeated)),
        "three different nodes", "remove them, or lower the weld tolerance");
    return;  // their edges would be reported as crowded too
  }
  const std::vector<EdgeUse> edges = sorted_edges(mesh.triangle);
  if (const auto twice = duplicate_triangles(mesh, edges); !twice.empty()) {
    add(fmt::format("{} pair(s) of triangles with the same nodes: {}", twice.size(), named(twice)),
        "every triangle once", "remove the duplicates");
  }
  if (const auto crowded = crowded_edges(mesh, edges); !crowded.empty()) {
    add(fmt::format("it is not a manifold: {} edge(s) belong to more than two triangles: {}", crowded.size(),
                    named(crowded)),
        "at most two triangles at an edge", "remove duplicate triangles, or split the parts into separate bodies");
  }
  if (errors.size() == before) {
    std::vector<Triangle> copy = mesh.triangle;
    if (!orient_consistently(copy)) {
      add("its triangles cannot be given a common side (it is a Moebius strip)", "an orientable surface",
          "cut the surface along a line");
    }
  }
}

}  // namespace fexp::model
