// SPDX-License-Identifier: Apache-2.0
#include "contact/edge_search.hpp"

#include <algorithm>
#include <cmath>

#include "contact/edge_watch.hpp"
#include "contact/near_pairs.hpp"
#include "parallel/parallel.hpp"
#include "physics/closest_lines.hpp"

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
          edges_.push_back({{}, edge, edge_reach(model, edge) * (1.0 + distance_rounding)});
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
  take_edges(model, x, skin);
  if (barriers_) {
    leave_out_far_barriers(model);
  }
  tree_.build(block_box_);
  const auto blocks = static_cast<Index>(blocks_.size());
  parallel::for_each(static_cast<Index>(pairs_.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    for (Index a = piece * piece_blocks; a < std::min((piece + 1) * piece_blocks, blocks); ++a) {
      tree_.query(block_box_[at(a)], [&](Index b) {
        if (b >= a) {
          try_blocks(model, x, skin, a, b, pairs);
        }
      });
    }
  });
  fill_rows(remembered, found);
}

void EdgeSearch::take_edges(const model::Model& model, const Positions& x, double skin) {
  parallel::for_each(static_cast<Index>(blocks_.size()), block_grain, [&](Index i) {
    Box box;
    for (Index k = first_edge_[at(i)]; k < first_edge_[at(i) + 1]; ++k) {
      Edge& edge = edges_[at(k)];
      const std::array<Index, 2> n = ends_of(model, edge.number);
      Box own;
      own.include(x(n[0]));
      own.include(x(n[1]));
      edge.box = own.grown((edge.reach + 0.5 * skin) * (1.0 + distance_rounding));
      box.include(edge.box);
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

/// Appends the pairs of two blocks, or of a block with itself.
void EdgeSearch::try_blocks(const model::Model& model, const Positions& x, double skin, Index a, Index b,
                            std::vector<Pair>& pairs) const {
  const Index body_a = model.blocks[at(blocks_[at(a)])].body, body_b = model.blocks[at(blocks_[at(b)])].body;
  if ((model.bodies[at(body_a)].barrier && model.bodies[at(body_b)].barrier) || !model.can_touch(body_a, body_b)) {
    return;
  }
  for (Index i = first_edge_[at(a)]; i < first_edge_[at(a) + 1]; ++i) {
    const Edge& first = edges_[at(i)];
    if (!first.box.overlaps(block_box_[at(b)])) {
      continue;
    }
    for (Index j = a == b ? i + 1 : first_edge_[at(b)]; j < first_edge_[at(b) + 1]; ++j) {
      const Edge& second = edges_[at(j)];
      if (!first.box.overlaps(second.box)) {
        continue;
      }
      const std::array<Index, 2> p = ends_of(model, first.number), q = ends_of(model, second.number);
      if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) {
        continue;
      }
      const double distance = std::sqrt(physics::edge_distance2(x(p[0]), x(p[1]), x(q[0]), x(q[1])));
      const double slack = distance * (1.0 - distance_rounding) - (first.reach + second.reach);
      if (slack <= skin) {
        pairs.push_back({first.number, second.number, slack});
      }
    }
  }
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
