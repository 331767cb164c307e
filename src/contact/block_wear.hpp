// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/block_pairs.hpp"

namespace fexp::contact {

/// How far blocks have moved against each of their partners since the two were searched, so that what has not moved
/// much need not be searched again: most of what is near a block belongs to the same sheet and moves with it. Partners
/// are meant by where they stand in BlockPairs::partners.
class BlockWear {
 public:
  /// All partners are due to be searched at the positions x.
  void begin(const BlockPairs& pairs, const Positions& x);

  /// Adds what nodes have moved since the last call of this or of begin, and `rounding` [length].
  void add(const BlockPairs& pairs, const Positions& x, double rounding);

  /// Partners have been found anew: those that were none before are due.
  void take_over(const BlockPairs& pairs);

  /// Makes partners due that have used up half of `skin` [length], or nearly all where these are many, and starts anew
  /// with all that are due. Returns the blocks that have such. The marks stay until the next call of add.
  [[nodiscard]] std::vector<Index> take_due(const BlockPairs& pairs, double skin);
  [[nodiscard]] bool is_due(Index partner) const noexcept { return due_[at(partner)] != Due::no; }
  /// Whether there may be anything to find: boxes of the two blocks overlap.
  [[nodiscard]] bool is_due_and_near(Index partner) const noexcept { return due_[at(partner)] == Due::near; }

  /// Bound of the relative motion of any nodes of the two blocks since they were searched [length].
  [[nodiscard]] double used(Index partner) const noexcept { return used_[at(partner)]; }
  /// The largest of these [length].
  [[nodiscard]] double most_used() const noexcept;
  /// The largest that the last call of add has added to one of them [length].
  [[nodiscard]] double last() const noexcept { return last_; }
  /// Bound of the relative motion of any two nodes since the last call of begin or take_over [length].
  [[nodiscard]] double whole() const noexcept { return whole_; }
  /// Largest coordinate at the last call of begin or add [length].
  [[nodiscard]] double farthest() const noexcept { return farthest_; }

 private:
  enum class Due : std::uint8_t { no, apart, near };

  /// Of the nodes of a block.
  struct Way {
    Box way;         // At the last call of add [length]
    Box place;       // At the last call of begin or add [length]
    double added{};  // The most that one of its partners has been given [length]
  };

  [[nodiscard]] Box reached_by(const BlockPairs& pairs, Index block, double skin) const;

  std::vector<Vec3d> at_;     // [pairs.nodes()]
  std::vector<Way> ways_;     // [blocks]
  std::vector<double> used_;  // [partners]
  std::vector<double> old_used_;
  std::vector<Due> due_;  // [partners]
  double last_{};
  double whole_{};
  double farthest_{};
};

/// Calls visit(pair, slack) for what searches have found of each block and those that are its partners, with what is
/// left of the slack. A pair names its `partner`, and those of one partner stand side by side.
template <class Pair, class Visit>
void for_each_found(const BlockPairs& pairs, const BlockWear& wear, const std::vector<std::vector<Pair>>& found,
                    const Visit& visit) {
  for (Index block = 0; block < pairs.count(); ++block) {
    Index named = no_index, partner = no_index;
    for (const Pair& pair : found[at(block)]) {
      if (pair.partner != named) {
        named = pair.partner;
        partner = pairs.find(block, named);
      }
      if (partner != no_index) {
        visit(pair, pair.slack - wear.used(partner));
      }
    }
  }
}

/// Takes out of what was found of a block what is to be found again, and what is of no partner of its.
template <class Pair>
void leave_out_due(const BlockPairs& pairs, const BlockWear& wear, Index block, std::vector<Pair>& found) {
  std::erase_if(found, [&](const Pair& pair) {
    const Index partner = pairs.find(block, pair.partner);
    return partner == no_index || wear.is_due(partner);
  });
}

}  // namespace fexp::contact
