// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/index.hpp"
#include "model/model.hpp"

namespace fexp::solve {

/// Consecutive blocks of one body whose corner forces fit into the cache until they are summed at the nodes.
struct Patch {
  Index body{};
  IndexRange elements;
  IndexRange blocks;
  IndexRange nodes;   ///< Into Patches::inner_node.
  IndexRange shared;  ///< Into Patches::shared_corner.
};

/// A corner whose node has elements in other patches, too: its force goes to a place of its own among those of the
/// node.
struct SharedCorner {
  Index corner{};  ///< 3 x element + corner
  Index place{};   ///< Into the border forces
};

/// The cut of a model into patches. Most nodes have all their elements in one patch and are done with it; the others
/// make up the border and are done when all patches are. A node's forces are summed in the order of its corners either
/// way, so that the cut changes no bit.
struct Patches {
  explicit Patches(const model::Model& model);

  std::vector<Patch> patches;            // In order of bodies
  std::vector<IndexRange> body_patches;  // [bodies]: into patches
  std::vector<Index> inner_node;         // Ascending in each patch
  std::vector<SharedCorner> shared_corner;
  std::vector<Index> border_node;       // Ascending
  std::vector<Index> border_start;      // [border nodes + 1]: places of a node's corners, in their order
  std::vector<IndexRange> body_border;  // [bodies]: into border_node
};

}  // namespace fexp::solve
