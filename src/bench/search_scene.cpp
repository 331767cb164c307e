// SPDX-License-Identifier: Apache-2.0
#include "bench/search_scene.hpp"

#include "bench/scenes.hpp"
#include "parallel/parallel.hpp"

namespace fexp::bench {

namespace {

/// Elements in a piece of work.
constexpr Index grain = 256;

}  // namespace

SearchScene::SearchScene(Index elements) : sphere(bench::sphere(elements)), skin(0.4 * sphere.node_size.front()) {
  for (const auto& t : sphere.triangle) {
    Box box;
    for (const Index n : t) {
      box.include(sphere.reference_position[at(n)]);
    }
    boxes.push_back(box.grown(sphere.half_thickness.front() + skin));
  }
  for (const model::ElementBlock& block : sphere.blocks) {
    Box box;
    for (Index e = block.first; e < block.first + block.count; ++e) {
      for (const Index n : sphere.triangle[at(e)]) {
        box.include(sphere.reference_position[at(n)]);
      }
    }
    block_boxes.push_back(box);
  }
}

void ask_all(const contact::KdTree& tree, const std::vector<Box>& boxes, std::vector<Index>& found) {
  found.resize(boxes.size());
  parallel::for_each(static_cast<Index>(boxes.size()), grain, [&](Index i) {
    Index count = 0;
    tree.query(boxes[at(i)], [&](Index) { ++count; });
    found[at(i)] = count;
  });
}

}  // namespace fexp::bench
