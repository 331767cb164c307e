// SPDX-License-Identifier: Apache-2.0
#include "contact/block_pairs.hpp"

#include <algorithm>
#include <array>

#include "contact/near_pairs.hpp"
#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index box_grain = 512;
/// Blocks for each piece of the tree that is searched by itself.
constexpr Index blocks_in_piece = 64;

}  // namespace

void BlockPairs::assign(const model::Model& model, std::span<const Index> bodies) {
  blocks_.clear();
  body_.clear();
  reach_.clear();
  node_.clear();
  first_node_.assign(1, 0);
  barriers_ = false;
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    barriers_ = barriers_ || body.barrier;
    for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
      const model::ElementBlock& block = model.blocks[at(b)];
      blocks_.push_back(b);
      body_.push_back(index);
      const auto first = static_cast<std::ptrdiff_t>(node_.size());
      for (Index e = block.first; e < block.first + block.count; ++e) {
        node_.insert(node_.end(), model.triangle[at(e)].begin(), model.triangle[at(e)].end());
      }
      std::sort(node_.begin() + first, node_.end());
      node_.erase(std::unique(node_.begin() + first, node_.end()), node_.end());
      double reach = 0.0;
      for (auto n = node_.begin() + first; n != node_.end(); ++n) {
        reach = std::max(reach, model.half_thickness[at(*n)] + model::watch_margin(model.node_size[at(*n)]));
      }
      reach_.push_back(reach);
      first_node_.push_back(static_cast<Index>(node_.size()));
    }
  }
  box_.resize(blocks_.size());
  tree_ = {};
  start_.assign(blocks_.size() + 1, 0);
  partner_.clear();
}

void BlockPairs::search(const model::Model& model, const Positions& x, double skin) {
  take_boxes(x, skin);
  if (barriers_) {
    leave_out_far_barriers(model);
  }
  tree_.update(box_);
  const std::vector<BoxTree::Meeting> meetings = tree_.meetings(at(count() / blocks_in_piece));
  pairs_.resize(meetings.size());
  parallel::for_each(static_cast<Index>(meetings.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    tree_.meet(meetings[at(piece)], [&](Index first, Index second) {
      const Index a = body_[at(first)], b = body_[at(second)];
      if (model.can_touch(a, b) && !(barriers_ && model.bodies[at(a)].barrier && model.bodies[at(b)].barrier)) {
        pairs.push_back({first, second});
      }
    });
  });
  fill_rows();
}

void BlockPairs::take_boxes(const Positions& x, double skin) {
  parallel::for_each(count(), box_grain, [&](Index i) {
    Box box;
    for (Index k = first_node_[at(i)]; k < first_node_[at(i) + 1]; ++k) {
      box.include(x(node_[at(k)]));
    }
    box_[at(i)] = box.grown((reach_[at(i)] + 0.5 * skin) * (1.0 + distance_rounding));
  });
}

/// Barriers do not touch each other, and may be far larger than the island.
void BlockPairs::leave_out_far_barriers(const model::Model& model) {
  const auto is_barrier = [&](std::size_t i) { return model.bodies[at(body_[i])].barrier; };
  Box free;
  for (std::size_t i = 0; i < box_.size(); ++i) {
    if (!is_barrier(i)) {
      free.include(box_[i]);
    }
  }
  for (std::size_t i = 0; i < box_.size(); ++i) {
    if (is_barrier(i) && !free.overlaps(box_[i])) {
      box_[i] = {};
    }
  }
}

/// Sorts the pairs by block, each from both sides.
void BlockPairs::fill_rows() {
  old_start_.swap(start_);
  old_partner_.swap(partner_);
  start_.assign(blocks_.size() + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (const std::vector<Pair>& pairs : pairs_) {
      for (const Pair& pair : pairs) {
        visit(pair.first, pair.second);
        if (pair.first != pair.second) {
          visit(pair.second, pair.first);
        }
      }
    }
  };
  for_each_side([&](Index block, Index) { ++start_[at(block) + 1]; });
  for (std::size_t i = 1; i < start_.size(); ++i) {
    start_[i] += start_[i - 1];
  }
  partner_.resize(at(start_.back()));
  before_.resize(partner_.size());
  place_.assign(start_.begin(), start_.end() - 1);
  for_each_side([&](Index block, Index other) { partner_[at(place_[at(block)]++)] = other; });
  parallel::for_each(count(), box_grain, [&](Index i) {
    std::sort(partner_.begin() + start_[at(i)], partner_.begin() + start_[at(i) + 1]);
    Index old = old_start_[at(i)];
    const Index old_end = old_start_[at(i) + 1];
    for (Index k = start_[at(i)]; k < start_[at(i) + 1]; ++k) {
      while (old < old_end && old_partner_[at(old)] < partner_[at(k)]) {
        ++old;
      }
      before_[at(k)] = old < old_end && old_partner_[at(old)] == partner_[at(k)] ? old : no_index;
    }
  });
}

Index BlockPairs::find(Index block, Index partner) const noexcept {
  const auto begin = partner_.begin() + start_[at(block)], end = partner_.begin() + start_[at(block) + 1];
  const auto found = std::lower_bound(begin, end, partner);
  return found == end || *found != partner ? no_index : static_cast<Index>(found - partner_.begin());
}

std::vector<Index> BlockPairs::with_partners(std::span<const Index> blocks) const {
  std::vector<char> taken(blocks_.size());
  for (const Index block : blocks) {
    taken[at(block)] = 1;
    for (Index k = start_[at(block)]; k < start_[at(block) + 1]; ++k) {
      taken[at(partner_[at(k)])] = 1;
    }
  }
  std::vector<Index> all;
  for (Index block = 0; block < count(); ++block) {
    if (taken[at(block)] != 0) {
      all.push_back(block);
    }
  }
  return all;
}

}  // namespace fexp::contact
