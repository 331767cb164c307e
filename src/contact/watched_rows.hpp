// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "contact/candidate_rows.hpp"
#include "model/state.hpp"
#include "parallel/parallel.hpp"

namespace fexp::contact {

[[nodiscard]] inline Index owner_of(const model::ContactSide& side) noexcept { return side.node; }
[[nodiscard]] inline Index owner_of(const model::EdgeSide& side) noexcept { return side.first; }
[[nodiscard]] inline Index partner_of(const model::ContactSide& side) noexcept { return side.element; }
[[nodiscard]] inline Index partner_of(const model::EdgeSide& side) noexcept { return side.second; }

/// Candidates of an island's nodes, or of its edges, with the sides that are remembered of pairs and the pairs that
/// push now. Rows are looked at in pieces, side by side.
template <class Side, class Active>
class WatchedRows {
 public:
  /// Takes up what is remembered, in any order.
  void assign(std::vector<Side> memory) {
    std::sort(memory.begin(), memory.end(), [](const Side& a, const Side& b) {
      return owner_of(a) != owner_of(b) ? owner_of(a) < owner_of(b) : partner_of(a) < partner_of(b);
    });
    candidates_ = {};
    pieces_.clear();
    pieces_.emplace_back().memory = std::move(memory);
  }

  [[nodiscard]] std::vector<Side> all_sides() const {
    std::vector<Side> sides;
    for (const Piece& piece : pieces_) {
      sides.insert(sides.end(), piece.memory.begin(), piece.memory.end());
    }
    return sides;
  }

  /// Calls `list` with the nodes or edges of which something is remembered (ascending, with repeats), which have to
  /// have a row, and the candidates to be filled.
  template <class List>
  void renew(const List& list) {
    const std::vector<Side> memory = all_sides();
    std::vector<Index> remembered;
    remembered.reserve(memory.size());
    for (const Side& side : memory) {
      remembered.push_back(owner_of(side));
    }
    list(remembered, candidates_);
    cut(memory);
  }

  [[nodiscard]] Index candidate_count() const noexcept { return static_cast<Index>(candidates_.partner.size()); }

  /// Looks at all pairs that may be near, each piece by a watch of its own from `watch()`. Since the candidates were
  /// listed, no two nodes near each other have moved by more than `moved` relative to each other [length], nor any two
  /// by more than `travelled`.
  template <class Watch>
  void look(double moved, double travelled, const Watch& watch) {
    parallel::for_each(static_cast<Index>(pieces_.size()), piece_grain,
                       [&](Index i) { look(moved, travelled, watch, pieces_[at(i)]); });
  }

  /// Calls visit(Active) for the pairs with a force, in ascending order.
  template <class Visit>
  void for_each_active(const Visit& visit) const {
    for (const Piece& piece : pieces_) {
      for (const Active& pair : piece.active) {
        visit(pair);
      }
    }
  }

 private:
  static constexpr Index rows_per_piece = 64;
  static constexpr Index piece_grain = 4;

  /// Consecutive rows: the unit of parallel work. All lists ascend as rows do.
  struct Piece {
    Index first_row{};
    Index last_row{};
    std::vector<Side> memory;
    std::vector<Side> next_memory;
    std::vector<Active> active;
  };

  void cut(const std::vector<Side>& memory) {
    const auto rows = static_cast<Index>(candidates_.owner.size());
    pieces_.resize(at((rows + rows_per_piece - 1) / rows_per_piece));
    auto next = memory.begin();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      Piece& piece = pieces_[i];
      piece.first_row = static_cast<Index>(i) * rows_per_piece;
      piece.last_row = std::min(piece.first_row + rows_per_piece, rows);
      const Index last = candidates_.owner[at(piece.last_row - 1)];
      const auto end = std::find_if(next, memory.end(), [&](const Side& s) { return owner_of(s) > last; });
      piece.memory.assign(next, end);
      next = end;
    }
  }

  /// Most rows on most steps have nothing remembered and nothing near enough yet.
  template <class Watch>
  void look(double moved, double travelled, const Watch& make_watch, Piece& piece) {
    piece.active.clear();
    const auto is_due = [&](std::size_t row) {
      return candidates_.slack[row] <= moved && candidates_.row_due[row] <= travelled;
    };
    auto row = at(piece.first_row);
    const auto last_row = at(piece.last_row);
    if (piece.memory.empty()) {
      while (row < last_row && !is_due(row)) {
        ++row;
      }
      if (row == last_row) {
        return;
      }
    }
    auto watch = make_watch();
    piece.next_memory.clear();
    auto known = piece.memory.cbegin();
    for (; row < last_row; ++row) {
      const Index owner = candidates_.owner[row];
      auto end = known;
      while (end != piece.memory.cend() && owner_of(*end) == owner) {
        ++end;
      }
      if (known != end || is_due(row)) {
        watch.look(owner, candidates_.row(row, travelled), {known, end}, piece.next_memory, piece.active);
        const auto first = candidates_.due.cbegin() + candidates_.start[row];
        const auto last = candidates_.due.cbegin() + candidates_.start[row + 1];
        candidates_.row_due[row] = first == last ? HUGE_VAL : *std::min_element(first, last);
      }
      known = end;
    }
    piece.memory.swap(piece.next_memory);
  }

  CandidateRows candidates_;
  std::vector<Piece> pieces_;
};

}  // namespace fexp::contact
