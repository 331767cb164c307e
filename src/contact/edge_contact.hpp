// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/edge_search.hpp"
#include "contact/edge_watch.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::contact {

/// The pairs of edges of one island.
class EdgeContact {
 public:
  /// Takes up an island, with the sides that the state remembers of `bodies`; `all` are these and the barriers.
  void assign(const model::Model& model, std::span<const Index> bodies, std::span<const Index> all,
              const model::State& state);

  /// See EdgeSearch.
  void search(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> blocks, const Positions& x,
              double skin) {
    search_.search(pairs, wear, blocks, x, skin);
  }
  /// Takes up what searches have found.
  void list(const BlockPairs& pairs, const BlockWear& wear);

  /// Looks at all pairs; no two nodes near each other have moved by more than `moved` relative to each other since
  /// then.
  void look(const model::Model& model, const Positions& now, const Positions& before, double moved);

  /// Calls visit(ActiveEdges) for the pairs with a force, in ascending order.
  template <class Visit>
  void for_each_active(const Visit& visit) const {
    for (const Piece& piece : pieces_) {
      for (const ActiveEdges& pair : piece.active) {
        visit(pair);
      }
    }
  }

  [[nodiscard]] std::vector<model::EdgeSide> all_sides() const;
  [[nodiscard]] Index candidate_count() const noexcept { return static_cast<Index>(candidates_.second.size()); }

 private:
  /// Consecutive rows of candidates: the unit of parallel work. All lists ascend by (first, second).
  struct Piece {
    Index first_row{};
    Index last_row{};
    std::vector<model::EdgeSide> memory;
    std::vector<model::EdgeSide> next_memory;
    std::vector<ActiveEdges> active;
  };

  void look(const model::Model& model, const Positions& now, const Positions& before, double moved, Piece& piece) const;

  EdgeSearch search_;
  EdgeCandidates candidates_;
  std::vector<Piece> pieces_;
};

}  // namespace fexp::contact
