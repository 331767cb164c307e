// SPDX-License-Identifier: Apache-2.0
#include "contact/edge_contact.hpp"

#include <algorithm>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index rows_per_piece = 64;
constexpr Index piece_grain = 4;

bool by_pair(const model::EdgeSide& a, const model::EdgeSide& b) noexcept {
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

}  // namespace

void EdgeContact::assign(const model::Model& model, std::span<const Index> bodies, std::span<const Index> all,
                         const model::State& state) {
  pieces_.clear();
  candidates_ = {};
  search_.assign(model, all);
  Piece& piece = pieces_.emplace_back();
  for (const Index body : bodies) {
    piece.memory.insert(piece.memory.end(), state.edge_sides[at(body)].begin(), state.edge_sides[at(body)].end());
  }
  std::sort(piece.memory.begin(), piece.memory.end(), by_pair);
}

std::vector<model::EdgeSide> EdgeContact::all_sides() const {
  std::vector<model::EdgeSide> sides;
  for (const Piece& piece : pieces_) {
    sides.insert(sides.end(), piece.memory.begin(), piece.memory.end());
  }
  return sides;
}

void EdgeContact::list(const BlockPairs& pairs, const BlockWear& wear) {
  const std::vector<model::EdgeSide> memory = all_sides();
  std::vector<Index> remembered;
  remembered.reserve(memory.size());
  for (const model::EdgeSide& side : memory) {
    remembered.push_back(side.first);
  }
  search_.list(pairs, wear, remembered, candidates_);
  const auto rows = static_cast<Index>(candidates_.first.size());
  pieces_.resize(at((rows + rows_per_piece - 1) / rows_per_piece));
  auto next = memory.begin();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    Piece& piece = pieces_[i];
    piece.first_row = static_cast<Index>(i) * rows_per_piece;
    piece.last_row = std::min(piece.first_row + rows_per_piece, rows);
    const Index last = candidates_.first[at(piece.last_row - 1)];
    const auto end = std::find_if(next, memory.end(), [&](const model::EdgeSide& s) { return s.first > last; });
    piece.memory.assign(next, end);
    next = end;
  }
}

void EdgeContact::look(const model::Model& model, const Positions& now, const Positions& before, double moved) {
  const auto count = static_cast<Index>(pieces_.size());
  parallel::for_each(count, piece_grain, [&](Index i) { look(model, now, before, moved, pieces_[at(i)]); });
}

void EdgeContact::look(const model::Model& model, const Positions& now, const Positions& before, double moved,
                       Piece& piece) const {
  EdgeWatch watch(model, now, before);
  piece.active.clear();
  piece.next_memory.clear();
  auto known = piece.memory.cbegin();
  for (Index row = piece.first_row; row < piece.last_row; ++row) {
    const Index first = candidates_.first[at(row)];
    auto end = known;
    while (end != piece.memory.cend() && end->first == first) {
      ++end;
    }
    // Nothing remembered and nothing near enough yet: most rows on most steps.
    if (known != end || candidates_.slack[at(row)] <= moved) {
      const std::span<const Index> seconds(candidates_.second.data() + candidates_.start[at(row)],
                                           candidates_.second.data() + candidates_.start[at(row) + 1]);
      watch.look(first, seconds, {known, end}, piece.next_memory, piece.active);
    }
    known = end;
  }
  piece.memory.swap(piece.next_memory);
}

}  // namespace fexp::contact
