// SPDX-License-Identifier: Apache-2.0
#include "contact/pair_books.hpp"

#include <algorithm>
#include <utility>

namespace fexp::contact {

void PairBooks::assign(const model::State& state, std::span<const Index> bodies) {
  entries_.clear();
  last_ = 0;
  for (const Index body : bodies) {
    for (const model::PairBook& book : state.pair_books[at(body)]) {
      entries_.push_back({body, true, book});
    }
  }
}

void PairBooks::store(std::span<const Index> bodies, model::State& state) const {
  for (const Index body : bodies) {
    state.pair_books[at(body)].clear();
  }
  for (const Entry& entry : entries_) {
    const model::PairBook& book = entry.book;
    if (book != model::PairBook{.other = book.other}) {
      state.pair_books[at(entry.keeper)].push_back(book);
    }
  }
}

void PairBooks::open(bool still) {
  still_ = still;
  for (Entry& entry : entries_) {
    entry.book.energy = 0.0;
  }
}

void PairBooks::add(const model::Model& model, Index a, Index b, double energy, double dissipated) {
  model::PairBook& book = find(model, a, b).book;
  book.energy += energy;
  book.dissipated += dissipated;
}

void PairBooks::add_work(const model::Model& model, Index a, Index b, double on_a, double on_b) {
  Entry& entry = find(model, a, b);
  const bool in_order = entry.keeper == a;
  entry.book.work += in_order ? on_a : on_b;
  entry.book.work_other += in_order ? on_b : on_a;
}

void PairBooks::close() {
  for (Entry& entry : entries_) {
    if (!entry.is_old) {
      entry.is_old = true;
      entry.book.initial = entry.book.energy;
    }
  }
}

PairBooks::Entry& PairBooks::find(const model::Model& model, Index a, Index b) {
  if ((b < a && !model.bodies[at(b)].barrier) || model.bodies[at(a)].barrier) {
    std::swap(a, b);
  }
  if (last_ < entries_.size() && entries_[last_].keeper == a && entries_[last_].book.other == b) {
    return entries_[last_];
  }
  const auto found = std::ranges::lower_bound(entries_, std::pair{a, b}, {}, [](const Entry& entry) {
    return std::pair{entry.keeper, entry.book.other};
  });
  last_ = static_cast<std::size_t>(found - entries_.begin());
  if (found == entries_.end() || found->keeper != a || found->book.other != b) {
    return *entries_.insert(found, {a, !still_, model::PairBook{.other = b}});
  }
  return *found;
}

}  // namespace fexp::contact
