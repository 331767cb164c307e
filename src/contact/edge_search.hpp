// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/box_tree.hpp"
#include "contact/near_edges.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Pairs of edges that may come within watch distance while no two nodes of the island have moved by more than the skin
/// relative to each other: compressed rows over first edges, everything ascending.
struct EdgeCandidates {
  std::vector<Index> first;   // [rows]
  std::vector<Index> start;   // [rows + 1]
  std::vector<Index> second;  // [candidates]
  /// Relative motion below which no pair of the row comes within watch distance [length], shape [rows].
  std::vector<double> slack;
};

/// Finds pairs of edges that are near each other with a tree over boxes: every edge belongs to the block of the lower
/// of its elements, and the edges of blocks whose boxes overlap are tried with each other.
class EdgeSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// `remembered`: first edges (ascending, repeats allowed) that get a row in any case.
  void search(const model::Model& model, const Positions& x, double skin, std::span<const Index> remembered,
              EdgeCandidates& found);

 private:
  struct Pair {
    Index first;
    Index second;
    double slack;

    friend bool operator<(const Pair& a, const Pair& b) noexcept {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    }
  };

  void take_edges(const Positions& x, double skin);
  void leave_out_far_barriers(const model::Model& model);
  void try_block(const model::Model& model, double skin, Index index, std::vector<Pair>& pairs) const;
  [[nodiscard]] std::span<const NearEdge> edges_of(Index block) const;
  void fill_rows(std::span<const Index> remembered, EdgeCandidates& found);

  std::vector<Index> blocks_;             // Of all bodies, ascending
  std::vector<NearEdge> edges_;           // By block
  std::vector<Index> first_edge_;         // [blocks_ + 1]: into edges_
  std::vector<Box> block_box_;            // [blocks_]
  bool barriers_{};                       // Some of the bodies are
  BoxTree tree_;                          // Of block_box_
  std::vector<std::vector<Pair>> pairs_;  // By piece of blocks_
  std::vector<Pair> sorted_;
};

}  // namespace fexp::contact
