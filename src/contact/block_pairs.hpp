// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/box_tree.hpp"
#include "contact/surface.hpp"

namespace fexp::contact {

/// Pairs of blocks of elements that may touch each other, found by boxes: the first stage of the searches for nodes and
/// for edges. It may find pairs that are farther from each other than it must, so what the searches make of them does
/// not depend on the tree.
class BlockPairs {
 public:
  /// Takes up the bodies to search among, ascending, barriers included.
  void assign(const model::Model& model, std::span<const Index> bodies);

  /// Finds all pairs of blocks with a node of one closer than the skin to watch distance of a triangle of the other, or
  /// with such edges.
  void search(const model::Model& model, const Positions& x, double skin);

  /// Blocks of all bodies, ascending. Elsewhere here blocks are meant by their places in this list.
  [[nodiscard]] std::span<const Index> blocks() const noexcept { return blocks_; }
  /// Nodes of blocks, and which of them are a block's.
  [[nodiscard]] std::span<const Index> nodes() const noexcept { return node_; }
  [[nodiscard]] IndexRange nodes_of(Index block) const noexcept {
    return {first_node_[at(block)], first_node_[at(block) + 1]};
  }
  /// How far a block's nodes reach beyond their places: half thickness and the margin up to which they are watched.
  [[nodiscard]] double reach(Index block) const noexcept { return reach_[at(block)]; }
  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(blocks_.size()); }
  /// Blocks and all their partners, ascending.
  [[nodiscard]] std::vector<Index> with_partners(std::span<const Index> blocks) const;
  /// Where partners of a block stand among those of all, ascending: itself, too, where its body touches itself. Every
  /// pair stands there twice.
  [[nodiscard]] IndexRange partners_of(Index block) const noexcept {
    return {start_[at(block)], start_[at(block) + 1]};
  }
  [[nodiscard]] std::span<const Index> partners() const noexcept { return partner_; }
  /// Where a partner of a block stands, or no_index if it is none.
  [[nodiscard]] Index find(Index block, Index partner) const noexcept;
  /// For each of partners(), where it stood before the last search, or no_index.
  [[nodiscard]] std::span<const Index> before() const noexcept { return before_; }

 private:
  struct Pair {
    Index first;
    Index second;
  };

  void take_boxes(const Positions& x, double skin);
  void leave_out_far_barriers(const model::Model& model);
  void fill_rows();

  std::vector<Index> blocks_;
  std::vector<Index> body_;               // [blocks_]
  std::vector<double> reach_;             // [blocks_]: the largest of its nodes' [length]
  std::vector<Index> node_;               // By block, each once
  std::vector<Index> first_node_;         // [blocks_ + 1]: into node_
  std::vector<Box> box_;                  // [blocks_]: grown by the reach and half the skin
  bool barriers_{};                       // Some of the bodies are
  BoxTree tree_;                          // Of box_
  std::vector<std::vector<Pair>> pairs_;  // By piece of the tree
  std::vector<Index> old_start_;
  std::vector<Index> old_partner_;
  std::vector<Index> start_;  // [blocks_ + 1]: into partner_
  std::vector<Index> partner_;
  std::vector<Index> before_;  // [partner_]
  std::vector<Index> place_;   // [blocks_]: where fill_rows has come to
};

}  // namespace fexp::contact
