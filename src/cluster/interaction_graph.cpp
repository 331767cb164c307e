// SPDX-License-Identifier: Apache-2.0
#include "cluster/interaction_graph.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace fexp::cluster {

namespace {

double low(const Box& box, int axis) noexcept { return std::array{box.low.x, box.low.y, box.low.z}[std::size_t(axis)]; }
double high(const Box& box, int axis) noexcept {
  return std::array{box.high.x, box.high.y, box.high.z}[std::size_t(axis)];
}

/// Axis along which the boxes' centres spread most, measured in mean box extents: the best one to sweep along.
int sweep_axis(std::span<const Box> boxes) {
  int best = 0;
  double best_ratio = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    double smallest = HUGE_VAL, largest = -HUGE_VAL, extent = 0.0;
    for (const Box& box : boxes) {
      smallest = std::min(smallest, low(box, axis));
      largest = std::max(largest, high(box, axis));
      extent += high(box, axis) - low(box, axis);
    }
    const double ratio = extent > 0.0 ? (largest - smallest) * static_cast<double>(boxes.size()) / extent : 0.0;
    if (ratio > best_ratio) {
      best_ratio = ratio;
      best = axis;
    }
  }
  return best;
}

using Edge = std::pair<Index, Index>;

/// All pairs of bodies with overlapping boxes that may touch, by a sweep along one axis.
std::vector<Edge> overlapping_pairs(const model::Model& model, std::span<const Box> swept) {
  const int axis = sweep_axis(swept);
  std::vector<Index> order(swept.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = static_cast<Index>(i);
  }
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const double x = low(swept[at(a)], axis), y = low(swept[at(b)], axis);
    return x != y ? x < y : a < b;
  });
  std::vector<Edge> pairs;
  std::vector<Index> open;
  for (const Index body : order) {
    const Box& box = swept[at(body)];
    std::erase_if(open, [&](Index other) { return high(swept[at(other)], axis) < low(box, axis); });
    for (const Index other : open) {
      if (box.overlaps(swept[at(other)]) && model.can_touch(std::min(body, other), std::max(body, other))) {
        pairs.emplace_back(std::min(body, other), std::max(body, other));
      }
    }
    open.push_back(body);
  }
  return pairs;
}

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

std::vector<Island> find_islands(const model::Model& model, std::span<const Box> swept) {
  std::vector<Edge> joining, touching_barrier;
  for (const Edge& pair : overlapping_pairs(model, swept)) {
    const bool first = model.bodies[at(pair.first)].barrier, second = model.bodies[at(pair.second)].barrier;
    if (first != second) {
      touching_barrier.emplace_back(first ? pair.second : pair.first, first ? pair.first : pair.second);
    } else if (!first) {
      joining.push_back(pair);
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
