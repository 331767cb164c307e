// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::contact {

/// The books of all pairs of bodies in one island, see model::PairBook. Allocates when two bodies touch for the first
/// time.
class PairBooks {
 public:
  /// Takes up the books that the state has of `bodies`.
  void assign(const model::State& state, std::span<const Index> bodies);
  /// Writes all that are not zero to the state of the bodies that keep them, in place of those of `bodies`.
  void store(std::span<const Index> bodies, model::State& state) const;

  /// Before all potentials are booked anew. `still`: without a step.
  void open(bool still);
  void add(const model::Model& model, Index a, Index b, double energy, double dissipated);
  /// Work on body `a` and on body `b`.
  void add_work(const model::Model& model, Index a, Index b, double on_a, double on_b);
  /// Afterwards. What bodies have in store that touch before any step is what the run begins with.
  void close();

 private:
  struct Entry {
    Index keeper{};
    bool is_old{};  ///< Its initial potential is known
    model::PairBook book;
  };
  Entry& find(const model::Model& model, Index a, Index b);

  std::vector<Entry> entries_;  // In order of (keeper, other)
  std::size_t last_{};          // Where the entry before was: mostly the next one is the same
  bool still_{};
};

}  // namespace fexp::contact
