// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vec3.hpp"
#include "contact/kd_tree.hpp"
#include "model/model.hpp"

namespace fexp::bench {

/// What the contact search of one sphere looks for: the nodes that lie in the grown boxes of the elements.
struct SearchScene {
  /// With about so many elements.
  explicit SearchScene(Index elements);

  model::Model sphere;
  double skin{};                 ///< By how much the boxes are grown beyond contact distance [length]
  std::vector<Box> boxes;        ///< Of the elements, as the search grows them
  std::vector<Box> block_boxes;  ///< Of the nodes of blocks of elements
};

/// Asks the tree of the sphere's nodes by the boxes of all elements; sets for each of them how many nodes were found.
void ask_all(const contact::KdTree& tree, const std::vector<Box>& boxes, std::vector<Index>& found);

}  // namespace fexp::bench
