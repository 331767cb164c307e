// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/block_pairs.hpp"
#include "contact/block_wear.hpp"
#include "contact/candidate_rows.hpp"
#include "contact/near_pairs.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Finds candidates of nodes: every node belongs to the first block of elements that has it, and every block is tried,
/// its elements side by side, with the nodes of the blocks that it may touch. Pairs are taken by their distance and
/// sorted.
class CandidateSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// Searches those partners of `blocks` that are due. All are of the same bodies.
  void search(const model::Model& model, const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> blocks,
              const Positions& x, double skin);

  /// All pairs that searches have found of blocks that are partners, with what is left of their slack. `remembered`:
  /// nodes (ascending, repeats allowed) that get a row in any case.
  void list(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> remembered, CandidateRows& found);

  [[nodiscard]] Index node_count() const noexcept { return static_cast<Index>(nodes_.size()); }
  [[nodiscard]] std::span<const Index> nodes() const noexcept { return nodes_; }

 private:
  struct Pair {
    Index local;  ///< Into nodes_
    Index element;
    Index partner;  ///< The block that has the node
    double slack;   ///< At the search
  };

  void take_nodes(const Positions& x, std::span<const Index> blocks);
  void try_block(const model::Model& model, const BlockPairs& pairs, const BlockWear& wear, const Positions& x,
                 const SearchGeometry& geometry, Index index);

  std::vector<Index> nodes_;              // Of all bodies, ascending
  std::vector<NearNode> owned_;           // [nodes_], by the block that has them
  std::vector<Index> first_owned_;        // [blocks + 1]: into owned_
  std::vector<Index> row_size_;           // [nodes_]
  std::vector<std::vector<Pair>> found_;  // By block: of its elements
};

}  // namespace fexp::contact
