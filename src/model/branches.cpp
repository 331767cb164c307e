// SPDX-License-Identifier: Apache-2.0
#include "model/branches.hpp"

#include <algorithm>
#include <numeric>

namespace fexp::model {

std::vector<Index> edge_rounds(std::span<const Triangle> triangles) {
  std::vector<Index> next(3 * triangles.size());
  for_each_edge(sorted_edges(triangles), [&](std::span<const EdgeUse> uses) {
    for (std::size_t i = 0; i < uses.size(); ++i) {
      next[at(uses[i].corner)] = uses[(i + 1) % uses.size()].corner;
    }
  });
  return next;
}

std::vector<Index> corner_fans(std::span<const Triangle> triangles, std::span<const Triangle> neighbours) {
  std::vector<Index> fan(3 * triangles.size());
  std::iota(fan.begin(), fan.end(), 0);
  const auto corner_at = [&](Index triangle, Index node) {
    const Triangle& t = triangles[at(triangle)];
    return 3 * triangle + static_cast<Index>(std::find(t.begin(), t.end(), node) - t.begin());
  };
  std::vector<Index> stack;
  for (Index first = 0; first < static_cast<Index>(fan.size()); ++first) {
    // Every corner below has its fan, and gave it to all of that.
    if (fan[at(first)] != first) {
      continue;
    }
    const Index node = triangles[at(first / 3)][at(first % 3)];
    stack.assign(1, first);
    while (!stack.empty()) {
      const Index corner = stack.back();
      stack.pop_back();
      for (const Index edge : {corner % 3, (corner + 2) % 3}) {
        const Index other = neighbours[at(corner / 3)][at(edge)];
        if (other == no_index) {
          continue;
        }
        const Index across = corner_at(other, node);
        if (across != first && fan[at(across)] == across) {
          fan[at(across)] = first;
          stack.push_back(across);
        }
      }
    }
  }
  return fan;
}

}  // namespace fexp::model
