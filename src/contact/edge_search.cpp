// SPDX-License-Identifier: Apache-2.0
#include "contact/edge_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/edge_watch.hpp"
#include "contact/near_edges.hpp"
#include "contact/near_pairs.hpp"
#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index piece_blocks = 32;
constexpr Index block_grain = 512;

}  // namespace

void EdgeSearch::assign(const model::Model& model, std::span<const Index> bodies) {
  blocks_.clear();
  edges_.clear();
  first_edge_.assign(1, 0);
  barriers_ = false;
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    barriers_ = barriers_ || body.barrier;
    for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
      const model::ElementBlock& block = model.blocks[at(b)];
      blocks_.push_back(b);
      for (Index edge = 3 * block.first; edge < 3 * (block.first + block.count); ++edge) {
        const Index other = model.neighbour[at(edge / 3)][static_cast<std::size_t>(edge % 3)];
        if (other == no_index || edge / 3 < other) {
          NearEdge& near = edges_.emplace_back();
          near.reach = edge_reach(model, edge) * (1.0 + distance_rounding);
          near.node = ends_of(model, edge);
          near.number = edge;
        }
      }
      first_edge_.push_back(static_cast<Index>(edges_.size()));
    }
  }
  block_box_.resize(blocks_.size());
  pairs_.resize((blocks_.size() + at(piece_blocks) - 1) / at(piece_blocks));
}

void EdgeSearch::search(const model::Model& model, const Positions& x, double skin, std::span<const Index> remembered,
                        EdgeCandidates& found) {
  take_edges(x, skin);
  if (barriers_) {
    leave_out_far_barriers(model);
  }
  tree_.build(block_box_);
  const auto blocks = static_cast<Index>(blocks_.size());
  parallel::for_each(static_cast<Index>(pairs_.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    for (Index i = piece * piece_blocks; i < std::min((piece + 1) * piece_blocks, blocks); ++i) {
      try_block(model, skin, i, pairs);
    }
  });
  fill_rows(remembered, found);
}

std::span<const NearEdge> EdgeSearch::edges_of(Index block) const {
  return std::span(edges_).subspan(at(first_edge_[at(block)]), at(first_edge_[at(block) + 1] - first_edge_[at(block)]));
}

void EdgeSearch::take_edges(const Positions& x, double skin) {
  parallel::for_each(static_cast<Index>(blocks_.size()), block_grain, [&](Index i) {
    Box box;
    for (Index k = first_edge_[at(i)]; k < first_edge_[at(i) + 1]; ++k) {
      NearEdge& edge = edges_[at(k)];
      edge.begin = x(edge.node[0]);
      edge.end = x(edge.node[1]);
      edge.half_reach = (edge.reach + 0.5 * skin) * (1.0 + distance_rounding);
      box.include(edge.box());
    }
    block_box_[at(i)] = box;
  });
}

/// Barriers do not touch each other, and may be far larger than the island.
void EdgeSearch::leave_out_far_barriers(const model::Model& model) {
  const auto is_barrier = [&](std::size_t i) { return model.bodies[at(model.blocks[at(blocks_[i])].body)].barrier; };
  Box free;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (!is_barrier(i)) {
      free.include(block_box_[i]);
    }
  }
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (is_barrier(i) && !free.overlaps(block_box_[i])) {
      block_box_[i] = {};
    }
  }
}

/// Appends the pairs of a block with itself and with those behind it.
void EdgeSearch::try_block(const model::Model& model, double skin, Index index, std::vector<Pair>& pairs) const {
  const std::span<const NearEdge> own = edges_of(index);
  const Index body = model.blocks[at(blocks_[at(index)])].body;
  BlockEdges block;  // NOLINT(cppcoreguidelines-pro-type-member-init): make_ready fills it
  make_ready(own, block);
  tree_.query(block_box_[at(index)], [&](Index other) {
    const Index other_body = model.blocks[at(blocks_[at(other)])].body;
    if (other < index || (model.bodies[at(body)].barrier && model.bodies[at(other_body)].barrier) ||
        !model.can_touch(body, other_body)) {
      return;
    }
    const std::span<const NearEdge> others = edges_of(other);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only what the kernel has written is read
    std::array<NearEdgePair, at(most_edges) * at(most_edges)> found;
    const Index count =
        near_edge_kernels().back()(block, others.data(), static_cast<Index>(others.size()), skin, found.data());
    for (Index k = 0; k < count; ++k) {
      const NearEdgePair& pair = found[at(k)];
      pairs.push_back({own[at(pair.lane)].number, others[at(pair.edge)].number, pair.slack});
    }
  });
}

void EdgeSearch::fill_rows(std::span<const Index> remembered, EdgeCandidates& found) {
  sorted_.clear();
  for (const std::vector<Pair>& pairs : pairs_) {
    sorted_.insert(sorted_.end(), pairs.begin(), pairs.end());
  }
  std::sort(sorted_.begin(), sorted_.end());
  found.first.clear();
  found.start.assign(1, 0);
  found.second.clear();
  found.slack.clear();
  auto pair = sorted_.cbegin();
  auto kept = remembered.begin();
  while (pair != sorted_.cend() || kept != remembered.end()) {
    const Index first =
        kept == remembered.end() || (pair != sorted_.cend() && pair->first <= *kept) ? pair->first : *kept;
    double slack = HUGE_VAL;
    for (; pair != sorted_.cend() && pair->first == first; ++pair) {
      found.second.push_back(pair->second);
      slack = std::min(slack, pair->slack);
    }
    while (kept != remembered.end() && *kept == first) {
      ++kept;
    }
    found.first.push_back(first);
    found.start.push_back(static_cast<Index>(found.second.size()));
    found.slack.push_back(slack);
  }
}

}  // namespace fexp::contact
