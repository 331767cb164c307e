// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/block_pairs.hpp"
#include "contact/block_wear.hpp"
#include "contact/candidate_rows.hpp"
#include "contact/near_edges.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Finds pairs of edges that are near each other: every edge belongs to the block of the lower of its elements, and the
/// edges of blocks that may touch each other are tried with each other.
class EdgeSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// As those of CandidateSearch; what is remembered are first edges.
  void search(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> blocks, const Positions& x,
              double skin);
  void list(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> remembered, CandidateRows& found);

  [[nodiscard]] std::span<const NearEdge> edges_of(Index block) const;

 private:
  struct Pair {
    Index first;
    Index second;
    Index partner;  ///< The block that has the second
    double slack;   ///< At the search

    friend bool operator<(const Pair& a, const Pair& b) noexcept {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    }
  };

  void take_edges(const Positions& x, std::span<const Index> blocks, double skin);
  void try_block(const BlockPairs& pairs, const BlockWear& wear, double skin, Index block);

  std::vector<NearEdge> edges_;           // By block
  std::vector<Index> first_edge_;         // [blocks + 1]: into edges_
  std::vector<std::vector<Pair>> found_;  // By block: of its edges and those of blocks behind it
  std::vector<Pair> sorted_;
};

}  // namespace fexp::contact
