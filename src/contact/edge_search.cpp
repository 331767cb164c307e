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
constexpr Index edge_grain = 4096;

}  // namespace

void EdgeSearch::assign(const model::Model& model, std::span<const Index> bodies) {
  edges_.clear();
  first_edge_.assign(1, 0);
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
      const model::ElementBlock& block = model.blocks[at(b)];
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
  pairs_.resize((first_edge_.size() - 1 + at(piece_blocks) - 1) / at(piece_blocks));
}

void EdgeSearch::search(const BlockPairs& near, const Positions& x, double skin, std::span<const Index> remembered,
                        EdgeCandidates& found) {
  take_edges(x, skin);
  parallel::for_each(static_cast<Index>(pairs_.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    for (Index i = piece * piece_blocks; i < std::min((piece + 1) * piece_blocks, near.count()); ++i) {
      try_block(near, skin, i, pairs);
    }
  });
  fill_rows(remembered, found);
}

std::span<const NearEdge> EdgeSearch::edges_of(Index block) const {
  return std::span(edges_).subspan(at(first_edge_[at(block)]), at(first_edge_[at(block) + 1] - first_edge_[at(block)]));
}

void EdgeSearch::take_edges(const Positions& x, double skin) {
  parallel::for_each(static_cast<Index>(edges_.size()), edge_grain, [&](Index k) {
    NearEdge& edge = edges_[at(k)];
    edge.begin = x(edge.node[0]);
    edge.end = x(edge.node[1]);
    edge.half_reach = (edge.reach + 0.5 * skin) * (1.0 + distance_rounding);
  });
}

/// Appends the pairs of a block with itself and with those behind it.
void EdgeSearch::try_block(const BlockPairs& near, double skin, Index block, std::vector<Pair>& pairs) const {
  const std::span<const NearEdge> own = edges_of(block);
  BlockEdges ready;  // NOLINT(cppcoreguidelines-pro-type-member-init): make_ready fills it
  make_ready(own, ready);
  const std::span<const Index> all = near.near(block);
  for (auto other = std::ranges::lower_bound(all, block); other != all.end(); ++other) {
    const std::span<const NearEdge> others = edges_of(*other);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only what the kernel has written is read
    std::array<NearEdgePair, at(most_edges) * at(most_edges)> found;
    const Index count =
        near_edge_kernels().back()(ready, others.data(), static_cast<Index>(others.size()), skin, found.data());
    for (Index k = 0; k < count; ++k) {
      const NearEdgePair& pair = found[at(k)];
      pairs.push_back({own[at(pair.lane)].number, others[at(pair.edge)].number, pair.slack});
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
