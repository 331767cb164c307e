// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/index.hpp"

namespace fexp::contact {

/// What may come near one node or one edge: elements, or edges. A candidate need not be looked at before no two nodes
/// can have missed each other by more than what is `due`: nodes have travelled as far since the candidates were listed.
class CandidateRow {
 public:
  /// `travelled`: bound of the relative motion of any two nodes since the candidates were listed [length].
  CandidateRow(std::span<const Index> partners, std::span<double> due, double travelled) noexcept
      : partners_(partners), due_(due), travelled_(travelled) {}

  [[nodiscard]] std::size_t size() const noexcept { return partners_.size(); }
  [[nodiscard]] Index partner(std::size_t i) const noexcept { return partners_[i]; }
  /// The first from the i-th on that has to be looked at; size() where there is none.
  [[nodiscard]] std::size_t due_from(std::size_t i) const noexcept {
    while (i < due_.size() && due_[i] > travelled_) {
      ++i;
    }
    return i;
  }
  /// The i-th need not be looked at before nodes have moved by `motion` relative to each other [length].
  void leave_alone(std::size_t i, double motion) noexcept { due_[i] = travelled_ + motion; }

 private:
  std::span<const Index> partners_;
  std::span<double> due_;
  double travelled_;
};

/// Pairs that may come within watch distance while no two nodes of the island have moved by more than the skin relative
/// to each other: compressed rows over nodes or first edges, everything ascending.
struct CandidateRows {
  std::vector<Index> owner;    // Nodes or first edges [rows]
  std::vector<Index> start;    // [rows + 1]
  std::vector<Index> partner;  // Elements or second edges [candidates]
  /// Relative motion of blocks near each other below which no pair of the row comes within watch distance [length],
  /// shape [rows].
  std::vector<double> slack;
  /// How far nodes may travel before a pair has to be looked at [length], shape [candidates]: its slack at first, then
  /// what is left whenever it has been looked at in vain.
  std::vector<double> due;
  std::vector<double> row_due;  // The least of a row [length] [rows]

  [[nodiscard]] CandidateRow row(std::size_t r, double travelled) noexcept {
    const std::size_t first = at(start[r]), count = at(start[r + 1]) - first;
    return {{partner.data() + first, count}, {due.data() + first, count}, travelled};
  }
};

}  // namespace fexp::contact
