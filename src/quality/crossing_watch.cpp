// SPDX-License-Identifier: Apache-2.0
#include "quality/crossing_watch.hpp"

#include <algorithm>
#include <iterator>

namespace fexp::quality {

FrameCrossings CrossingWatch::look(std::span<const Vec3d> position, std::span<const char> alive) {
  FrameCrossings found;
  found.cuts = find_edge_cuts(surfaces_, position, alive);
  const std::set<BodyPair> cut = body_pairs(found.cuts);
  if (last_.empty()) {
    first_cuts_ = found.cuts;
    never_free_ = cut;
  } else {
    count(position, alive);
    std::erase_if(never_free_, [&](const BodyPair& pair) { return cut.count(pair) == 0; });
  }
  std::set_difference(found.cuts.begin(), found.cuts.end(), first_cuts_.begin(), first_cuts_.end(),
                      std::back_inserter(found.new_cuts));
  found.through = nodes_through(alive);
  last_.assign(position.begin(), position.end());
  return found;
}

std::set<CrossingWatch::BodyPair> CrossingWatch::body_pairs(const std::vector<EdgeCut>& cuts) const {
  std::set<BodyPair> pairs;
  for (const EdgeCut& cut : cuts) {
    const Index a = surfaces_.node_body[at(surfaces_.edge[at(cut.edge)][0])];
    pairs.insert(std::minmax(a, surfaces_.body_of_triangle(cut.triangle)));
  }
  return pairs;
}

void CrossingWatch::count(std::span<const Vec3d> position, std::span<const char> alive) {
  for (const NodePassage& passage : find_node_passages(surfaces_, last_, position, alive)) {
    if (never_free_.count(std::minmax(surfaces_.node_body[at(passage.node)], passage.body)) == 0) {
      sum_[{passage.node, passage.body}] += passage.sum;
    }
  }
  std::erase_if(sum_, [](const auto& entry) { return entry.second == 0; });
}

std::vector<NodePassage> CrossingWatch::nodes_through(std::span<const char> alive) const {
  if (sum_.empty()) {
    return {};
  }
  std::vector<char> node_alive(at(surfaces_.nodes()));
  for (std::size_t t = 0; t < surfaces_.triangle.size(); ++t) {
    if (alive[t] != 0) {
      for (const Index n : surfaces_.triangle[t]) {
        node_alive[at(n)] = 1;
      }
    }
  }
  std::vector<NodePassage> through;
  for (const auto& [key, sum] : sum_) {
    if (node_alive[at(key.first)] != 0) {
      through.push_back({key.first, key.second, sum});
    }
  }
  return through;
}

}  // namespace fexp::quality
