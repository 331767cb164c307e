// SPDX-License-Identifier: Apache-2.0
#include "cluster/interaction_graph.hpp"

#include <algorithm>
#include <utility>

#include "cluster/overlapping_boxes.hpp"
#include "cluster/wall_reach.hpp"

namespace fexp::cluster {

namespace {

using Edge = std::pair<Index, Index>;

/// Neighbours of each body as compressed rows.
struct Adjacency {
  std::vector<std::size_t> start;
  std::vector<Index> neighbour;
};

Adjacency adjacency(std::size_t bodies, const std::vector<Edge>& edges) {
  Adjacency rows;
  rows.start.assign(bodies + 1, 0);
  for (const auto& [a, b] : edges) {
    ++rows.start[at(a) + 1];
    ++rows.start[at(b) + 1];
  }
  for (std::size_t i = 0; i < bodies; ++i) {
    rows.start[i + 1] += rows.start[i];
  }
  rows.neighbour.resize(2 * edges.size());
  std::vector<std::size_t> next(rows.start.begin(), rows.start.end() - 1);
  for (const auto& [a, b] : edges) {
    rows.neighbour[next[at(a)]++] = b;
    rows.neighbour[next[at(b)]++] = a;
  }
  return rows;
}

}  // namespace

std::vector<Island> find_islands(const model::Model& model, std::span<const Box> swept, std::span<const Index> ties) {
  std::vector<Edge> joining, touching_barrier;
  const std::span<const Box> meshed = swept.first(at(model.meshed_body_count()));
  const bool nothing_touches = !model.contact.enabled;
  for (const Edge& pair : overlapping_pairs(nothing_touches ? std::span<const Box>{} : meshed)) {
    if (!model.can_touch(pair.first, pair.second)) {
      continue;
    }
    const bool first = model.bodies[at(pair.first)].barrier, second = model.bodies[at(pair.second)].barrier;
    if (first != second) {
      touching_barrier.emplace_back(first ? pair.second : pair.first, first ? pair.first : pair.second);
    } else if (!first) {
      joining.push_back(pair);
    }
  }
  for (const model::TiedBodies& tied : model.ties.bodies) {
    if (ties.empty() || ties[at(tied.body)] > 0) {
      joining.emplace_back(tied.body, tied.carrier);
    }
  }
  for (Index wall = model.meshed_body_count(); wall < model.body_count(); ++wall) {
    for (Index body = 0; body < model.meshed_body_count(); ++body) {
      if (!model.bodies[at(body)].barrier &&
          may_reach(model.walls[at(model.bodies[at(wall)].wall)], swept[at(wall)], swept[at(body)])) {
        joining.emplace_back(body, wall);
      }
    }
  }
  const Adjacency graph = adjacency(swept.size(), joining);

  std::vector<Island> islands;
  std::vector<Index> island_of(swept.size(), no_index);
  std::vector<Index> stack;
  for (Index seed = 0; seed < model.body_count(); ++seed) {
    if (island_of[at(seed)] != no_index || model.bodies[at(seed)].barrier) {
      continue;
    }
    const auto number = static_cast<Index>(islands.size());
    Island& island = islands.emplace_back();
    stack.assign(1, seed);
    island_of[at(seed)] = number;
    while (!stack.empty()) {
      const Index body = stack.back();
      stack.pop_back();
      island.bodies.push_back(body);
      for (std::size_t i = graph.start[at(body)]; i < graph.start[at(body) + 1]; ++i) {
        const Index other = graph.neighbour[i];
        if (island_of[at(other)] == no_index) {
          island_of[at(other)] = number;
          stack.push_back(other);
        }
      }
    }
    std::sort(island.bodies.begin(), island.bodies.end());
  }
  for (const auto& [body, barrier] : touching_barrier) {
    islands[at(island_of[at(body)])].barriers.push_back(barrier);
  }
  for (Island& island : islands) {
    std::sort(island.barriers.begin(), island.barriers.end());
    island.barriers.erase(std::unique(island.barriers.begin(), island.barriers.end()), island.barriers.end());
  }
  return islands;
}

}  // namespace fexp::cluster
