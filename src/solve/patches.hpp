// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/aligned_vector.hpp"
#include "base/index.hpp"
#include "model/model.hpp"
#include "model/patch_cut.hpp"

namespace fexp::solve {

/// Consecutive blocks of one body whose nodes' forces fit into the cache until they are summed.
struct Patch {
  Index body{};
  IndexRange elements;
  IndexRange blocks;
  IndexRange nodes;   ///< Into Patches::inner_node.
  IndexRange border;  ///< Into Patches::border_place.

  /// Forces of a patch are those of its inner nodes, of its border nodes, and one for lanes without an element.
  [[nodiscard]] Index force_count() const noexcept { return nodes.size() + border.size() + 1; }
};

/// Most forces a patch can have.
inline constexpr Index most_patch_forces = 3 * model::patch_elements + 1;

/// The cut of a model into patches. Most nodes have all their elements in one patch and are done with it; the others
/// make up the border and are done when all patches are: a patch's share of the force on them goes to a place of its
/// own. Inside a patch forces are added in the order of elements, and shares in the order of patches. The cut depends
/// on the model alone, so that sums are the same whoever works on the patches.
struct Patches {
  explicit Patches(const model::Model& model);

  std::vector<Patch> patches;            // In order of bodies
  std::vector<IndexRange> body_patches;  // [bodies]: into patches
  AlignedVector<Index> inner_node;       // Ascending in each patch
  std::vector<Index> border_place;       // Where a patch's shares go, in ascending order of its border nodes
  AlignedVector<std::uint16_t> corner;   // [blocks][block_lanes][3]: into the forces of the patch
  std::vector<Index> border_node;        // Ascending
  std::vector<Index> border_start;       // [border nodes + 1]: places of a node's shares, in order of patches
  std::vector<IndexRange> body_border;   // [bodies]: into border_node
};

}  // namespace fexp::solve
