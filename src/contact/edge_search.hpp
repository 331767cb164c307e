// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/block_pairs.hpp"
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

/// Finds pairs of edges that are near each other: every edge belongs to the block of the lower of its elements, and the
/// edges of blocks that may touch each other are tried with each other.
class EdgeSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// `near`: of the same bodies, positions and skin. `remembered`: first edges (ascending, repeats allowed) that get a
  /// row in any case.
  void search(const BlockPairs& near, const Positions& x, double skin, std::span<const Index> remembered,
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
  void try_block(const BlockPairs& near, double skin, Index block, std::vector<Pair>& pairs) const;
  [[nodiscard]] std::span<const NearEdge> edges_of(Index block) const;
  void fill_rows(std::span<const Index> remembered, EdgeCandidates& found);

  std::vector<NearEdge> edges_;           // By block
  std::vector<Index> first_edge_;         // [blocks + 1]: into edges_
  std::vector<std::vector<Pair>> pairs_;  // By piece of the blocks
  std::vector<Pair> sorted_;
};

}  // namespace fexp::contact
