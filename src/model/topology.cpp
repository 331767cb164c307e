// SPDX-License-Identifier: Apache-2.0
#include "model/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "model/branches.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

constexpr Index node_grain = 8192;
constexpr Index edge_grain = 16384;

std::vector<Triangle> neighbours_across(std::size_t triangles, const std::vector<EdgeUse>& edges) {
  std::vector<Triangle> neighbours(triangles, {no_index, no_index, no_index});
  const auto last = static_cast<Index>(edges.size()) - 1;
  parallel::for_each(last, edge_grain, [&](Index i) {
    const EdgeUse& use = edges[at(i)];
    const bool more = (i > 0 && use.same_edge(edges[at(i) - 1])) || (i + 1 < last && use.same_edge(edges[at(i) + 2]));
    if (use.same_edge(edges[at(i) + 1]) && !more) {
      const Index a = use.corner, b = edges[at(i) + 1].corner;
      neighbours[at(a / 3)][at(a % 3)] = b / 3;
      neighbours[at(b / 3)][at(b % 3)] = a / 3;
    }
  });
  return neighbours;
}

/// Unit vector in the triangle's plane that leads away from one of its edges.
Vec3d away_from_edge(const Mesh& mesh, Index corner) {
  const Triangle& t = mesh.triangle[at(corner / 3)];
  const auto edge = at(corner % 3);
  const Vec3d start = mesh.position[at(t[edge])], along = mesh.position[at(t[(edge + 1) % 3])] - start;
  const Vec3d from = mesh.position[at(t[(edge + 2) % 3])] - start;
  const Vec3d away = from - (dot(from, along) / dot(along, along)) * along;
  return (1.0 / norm(away)) * away;
}

/// Makes neighbours of the two triangles at each edge of more than two that go on most straightly. Returns whether
/// there are such edges.
bool join_straightest(const Mesh& mesh, const std::vector<EdgeUse>& edges, std::vector<Triangle>& neighbours) {
  bool any = false;
  for_each_edge(edges, [&](std::span<const EdgeUse> uses) {
    if (uses.size() <= 2) {
      return;
    }
    any = true;
    double straightest = HUGE_VAL;
    Index first = no_index, second = no_index;
    for (std::size_t i = 0; i < uses.size(); ++i) {
      for (std::size_t j = i + 1; j < uses.size(); ++j) {
        const double cosine = dot(away_from_edge(mesh, uses[i].corner), away_from_edge(mesh, uses[j].corner));
        if (cosine < straightest) {
          straightest = cosine;
          first = uses[i].corner;
          second = uses[j].corner;
        }
      }
    }
    neighbours[at(first / 3)][at(first % 3)] = second / 3;
    neighbours[at(second / 3)][at(second % 3)] = first / 3;
  });
  return any;
}

/// Whether the triangle goes from node a to node b along one of its edges.
bool runs_along(const Triangle& triangle, Index a, Index b) noexcept {
  return (triangle[0] == a && triangle[1] == b) || (triangle[1] == a && triangle[2] == b) ||
         (triangle[2] == a && triangle[0] == b);
}

/// Whether all neighbours agree about the side already, as in most meshes.
bool is_consistent(const std::vector<Triangle>& triangles, const std::vector<Triangle>& neighbours) {
  const IndexRange all{0, static_cast<Index>(triangles.size())};
  const auto agree = [&](Index begin, Index end) {
    bool good = true;
    for (Index t = begin; t < end; ++t) {
      for (std::size_t e = 0; e < 3; ++e) {
        const Index other = neighbours[at(t)][e];
        good = good && (other == no_index ||
                        !runs_along(triangles[at(other)], triangles[at(t)][e], triangles[at(t)][(e + 1) % 3]));
      }
    }
    return static_cast<char>(good);
  };
  return parallel::ordered_fold(all, edge_grain, char{1}, agree,
                                [](char a, char b) { return static_cast<char>(a != 0 && b != 0); }) != 0;
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
    if (edges[i].same_edge(edges[i + 1]) && a % 3 == 0 && a / 3 != b / 3 && opposite(a) == opposite(b)) {
      names.push_back(fmt::format("{} = {}", triangle_name(mesh, at(a / 3)), triangle_name(mesh, at(b / 3))));
    }
  }
  return names;
}

/// Edges of more triangles than may meet, by the first three of them.
std::vector<std::string> crowded_edges(const Mesh& mesh, const std::vector<EdgeUse>& edges) {
  std::vector<std::string> names;
  for_each_edge(edges, [&](std::span<const EdgeUse> uses) {
    if (uses.size() > at(most_at_edge)) {
      const auto name = [&](std::size_t i) { return triangle_name(mesh, at(uses[i].corner / 3)); };
      names.push_back(fmt::format("{}-{}-{}", name(0), name(1), name(2)));
    }
  });
  return names;
}

}  // namespace

/// They are counted into rows of the lower nodes, which are short and sorted each for itself.
std::vector<EdgeUse> sorted_edges(std::span<const Triangle> triangles) {
  const auto nodes_of = [&](std::size_t t, std::size_t e) {
    return std::minmax(triangles[t][e], triangles[t][(e + 1) % 3]);
  };
  Index highest = no_index;
  for (const Triangle& t : triangles) {
    highest = std::max({highest, t[0], t[1], t[2]});
  }
  std::vector<Index> start(at(highest) + 2, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      ++start[at(nodes_of(t, e).first) + 1];
    }
  }
  for (std::size_t n = 1; n < start.size(); ++n) {
    start[n] += start[n - 1];
  }
  std::vector<EdgeUse> edges(3 * triangles.size());
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const auto [low, high] = nodes_of(t, e);
      edges[at(next[at(low)]++)] = {low, high, static_cast<Index>(3 * t + e)};
    }
  }
  parallel::for_each(highest + 1, node_grain, [&](Index n) {
    std::sort(edges.begin() + start[at(n)], edges.begin() + start[at(n) + 1], [](const EdgeUse& x, const EdgeUse& y) {
      return x.high != y.high ? x.high < y.high : x.corner < y.corner;
    });
  });
  return edges;
}

std::vector<Triangle> edge_neighbours(std::span<const Triangle> triangles) {
  return neighbours_across(triangles.size(), sorted_edges(triangles));
}

std::vector<Index> boundary_nodes(std::span<const Triangle> triangles) {
  std::vector<Index> nodes;
  for_each_edge(sorted_edges(triangles), [&](std::span<const EdgeUse> uses) {
    if (uses.size() == 1) {
      nodes.push_back(uses[0].low);
      nodes.push_back(uses[0].high);
    }
  });
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

bool orient_consistently(std::vector<Triangle>& triangles, std::vector<Triangle>& neighbours) {
  if (is_consistent(triangles, neighbours)) {
    return true;
  }
  std::vector<char> seen(triangles.size(), 0);
  std::vector<std::size_t> stack;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (seen[seed] != 0) {
      continue;
    }
    seen[seed] = 1;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const std::size_t t = stack.back();
      stack.pop_back();
      for (std::size_t e = 0; e < 3; ++e) {
        const Index other = neighbours[t][e];
        if (other == no_index) {
          continue;
        }
        const std::size_t o = at(other);
        if (runs_along(triangles[o], triangles[t][e], triangles[t][(e + 1) % 3])) {
          if (seen[o] != 0) {
            return false;
          }
          turn(triangles[o], neighbours[o]);
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

void turn(Triangle& triangle, Triangle& neighbours) noexcept {
  std::swap(triangle[1], triangle[2]);
  std::swap(neighbours[0], neighbours[2]);
}

Surface check_mesh(const Mesh& mesh, const Place& place, std::string_view body, ErrorList& errors) {
  const auto add = [&](std::string message, std::string accepted, std::string cure) {
    errors.add(place, fmt::format("mesh of body \"{}\": {}", body, message), std::move(accepted), std::move(cure));
  };
  if (mesh.triangle.empty()) {
    add("it has no triangles", "at least one triangle", "export surface triangles, not only points or lines");
    return {};
  }
  const std::size_t before = errors.size();
  if (!numbers_make_sense(mesh, add)) {
    return {};
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
    return {};  // their edges would be reported as crowded too
  }
  const std::vector<EdgeUse> edges = sorted_edges(mesh.triangle);
  if (const auto twice = duplicate_triangles(mesh, edges); !twice.empty()) {
    add(fmt::format("{} pair(s) of triangles with the same nodes: {}", twice.size(), named(twice)),
        "every triangle once", "remove the duplicates");
  }
  if (const auto crowded = crowded_edges(mesh, edges); !crowded.empty()) {
    add(fmt::format("{} edge(s) belong to more than {} triangles: {}", crowded.size(), most_at_edge, named(crowded)),
        fmt::format("at most {} triangles at an edge", most_at_edge),
        "remove duplicate triangles, or split the parts into separate bodies");
  }
  if (errors.size() != before) {
    return {};
  }
  Surface surface{mesh.triangle, neighbours_across(mesh.triangle.size(), edges)};
  surface.branched = join_straightest(mesh, edges, surface.neighbour);
  bool oriented = orient_consistently(surface.triangle, surface.neighbour);
  if (!oriented && surface.branched) {
    surface.triangle = mesh.triangle;
    surface.neighbour = neighbours_across(mesh.triangle.size(), edges);
    oriented = orient_consistently(surface.triangle, surface.neighbour);
  }
  if (!oriented) {
    add("its triangles cannot be given a common side (it is a Moebius strip)", "an orientable surface",
        "cut the surface along a line");
    return {};
  }
  return surface;
}

}  // namespace fexp::model
