// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>
#include <vector>

#include "contact/block_pairs.hpp"
#include "contact/block_wear.hpp"
#include "contact/candidates.hpp"
#include "contact/edge_search.hpp"

namespace fexp::contact {

/// A search for everything that is near at one moment, as an island makes when it is taken up.
class WholeSearch {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies) {
    pairs_.assign(model, bodies);
    nodes_.assign(model, bodies);
    edges_.assign(model, bodies);
    blocks_.resize(at(pairs_.count()));
    std::iota(blocks_.begin(), blocks_.end(), 0);
  }

  void find_partners(const model::Model& model, const Positions& x, double skin) {
    pairs_.search(model, x, skin);
    wear_.begin(pairs_, x);
  }
  void find_nodes(const model::Model& model, const Positions& x, double skin, std::span<const Index> remembered,
                  CandidateRows& found) {
    nodes_.search(model, pairs_, wear_, blocks_, x, skin);
    nodes_.list(pairs_, wear_, remembered, found);
  }
  void find_edges(const Positions& x, double skin, std::span<const Index> remembered, CandidateRows& found) {
    edges_.search(pairs_, wear_, blocks_, x, skin);
    edges_.list(pairs_, wear_, remembered, found);
  }

  /// Those that find_partners has found.
  [[nodiscard]] const BlockPairs& partners() const noexcept { return pairs_; }
  /// Edges of a block, each of the island's once; only their nodes and numbers are sure to be there.
  [[nodiscard]] std::span<const NearEdge> edges_of(Index block) const { return edges_.edges_of(block); }

 private:
  BlockPairs pairs_;
  BlockWear wear_;
  CandidateSearch nodes_;
  EdgeSearch edges_;
  std::vector<Index> blocks_;  // All
};

}  // namespace fexp::contact
