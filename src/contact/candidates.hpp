// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/box_tree.hpp"
#include "contact/near_pairs.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Pairs of nodes and elements that may come within watch distance while no two nodes of the island have moved by more
/// than the skin relative to each other: compressed rows over nodes, everything ascending.
struct Candidates {
  std::vector<Index> node;     // [rows]
  std::vector<Index> start;    // [rows + 1]
  std::vector<Index> element;  // [candidates]
  /// Relative motion below which no pair of the row comes within watch distance [length], shape [rows].
  std::vector<double> slack;
};

/// Finds candidates with a tree over boxes: every node belongs to the first block of elements that has it, and every
/// block is tried, its elements side by side, with the nodes of the blocks whose nodes reach its box. What is found
/// does not depend on the tree: pairs are taken by their distance and sorted.
class CandidateSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// `remembered`: nodes (ascending, repeats allowed) that get a row in any case.
  void search(const model::Model& model, const Positions& x, double skin, std::span<const Index> remembered,
              Candidates& found);

  [[nodiscard]] Index node_count() const noexcept { return static_cast<Index>(nodes_.size()); }
  [[nodiscard]] std::span<const Index> nodes() const noexcept { return nodes_; }

 private:
  struct Pair {
    Index local;  ///< Into nodes_
    Index element;
    double slack;
  };

  void take_nodes(const Positions& x);
  void leave_out_far_barriers(const model::Model& model, double skin);
  void query(const model::Model& model, const Positions& x, double skin);
  void try_block(const model::Model& model, const Positions& x, const SearchGeometry& geometry, Index index,
                 std::vector<Pair>& pairs) const;
  void fill_rows(std::span<const Index> remembered, Candidates& found);

  std::vector<Index> nodes_;              // Of all bodies, ascending
  std::vector<Index> blocks_;             // Of all bodies, ascending
  std::vector<NearNode> owned_;           // [nodes_], by the block that has them
  std::vector<Index> first_owned_;        // [blocks_ + 1]: into owned_
  std::vector<Index> row_size_;           // [nodes_]
  bool barriers_{};                       // Some of the bodies are
  Box free_;                              // What the nodes of the other bodies reach
  std::vector<Box> node_box_;             // [blocks_]: what the nodes of a block reach
  BoxTree tree_;                          // Of node_box_
  std::vector<std::vector<Pair>> pairs_;  // By piece of blocks_
};

}  // namespace fexp::contact
