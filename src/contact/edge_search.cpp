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

constexpr Index search_grain = 32;
constexpr Index block_grain = 512;

}  // namespace

void EdgeSearch::assign(const model::Model& model, std::span<const Index> bodies) {
  edges_.clear();
  first_edge_.assign(1, 0);
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
      const model::ElementBlock& block = model.blocks[at(b)];
      for (Index edge = 3 * block.first; edge < 3 * (block.first + block.count); ++edge) {
        bool lowest = true;
        model::for_each_at_edge(model, edge, [&](Index other) { lowest = lowest && edge / 3 < other; });
        if (lowest) {
          NearEdge& near = edges_.emplace_back();
          near.reach = edge_reach(model, edge) * (1.0 + distance_rounding);
          near.node = ends_of(model, edge);
          near.number = edge;
        }
      }
      first_edge_.push_back(static_cast<Index>(edges_.size()));
    }
  }
  found_.assign(first_edge_.size() - 1, {});
}

void EdgeSearch::search(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> blocks,
                        const Positions& x, double skin) {
  take_edges(x, pairs.with_partners(blocks), skin);
  parallel::for_each(static_cast<Index>(blocks.size()), search_grain,
                     [&](Index i) { try_block(pairs, wear, skin, blocks[at(i)]); });
}

std::span<const NearEdge> EdgeSearch::edges_of(Index block) const {
  return std::span(edges_).subspan(at(first_edge_[at(block)]), at(first_edge_[at(block) + 1] - first_edge_[at(block)]));
}

void EdgeSearch::take_edges(const Positions& x, std::span<const Index> blocks, double skin) {
  parallel::for_each(static_cast<Index>(blocks.size()), block_grain, [&](Index i) {
    const std::size_t block = at(blocks[at(i)]);
    for (Index k = first_edge_[block]; k < first_edge_[block + 1]; ++k) {
      NearEdge& edge = edges_[at(k)];
      edge.begin = x(edge.node[0]);
      edge.end = x(edge.node[1]);
      edge.half_reach = (edge.reach + 0.5 * skin) * (1.0 + distance_rounding);
    }
  });
}

/// Finds the pairs of a block with itself and with those behind it.
void EdgeSearch::try_block(const BlockPairs& pairs, const BlockWear& wear, double skin, Index block) {
  std::vector<Pair>& found = found_[at(block)];
  leave_out_due(pairs, wear, block, found);
  const std::span<const NearEdge> own = edges_of(block);
  BlockEdges edges;  // NOLINT(cppcoreguidelines-pro-type-member-init): make_ready fills it
  bool ready = false;
  const IndexRange partners = pairs.partners_of(block);
  for (Index p = partners.begin; p < partners.end; ++p) {
    const Index partner = pairs.partners()[at(p)];
    if (partner < block || !wear.is_due_and_near(p)) {
      continue;
    }
    if (!ready) {
      make_ready(own, edges);
      ready = true;
    }
    const std::span<const NearEdge> others = edges_of(partner);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only what the kernel has written is read
    std::array<NearEdgePair, at(most_edges) * at(most_edges)> near;
    const Index count =
        near_edge_kernels().back()(edges, others.data(), static_cast<Index>(others.size()), skin, near.data());
    for (Index k = 0; k < count; ++k) {
      const NearEdgePair& pair = near[at(k)];
      found.push_back({own[at(pair.lane)].number, others[at(pair.edge)].number, partner, pair.slack});
    }
  }
}

void EdgeSearch::list(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> remembered,
                      CandidateRows& found) {
  sorted_.clear();
  for_each_found(pairs, wear, found_, [&](const Pair& pair, double slack) {
    sorted_.push_back({pair.first, pair.second, pair.partner, slack});
  });
  std::sort(sorted_.begin(), sorted_.end());
  found.owner.clear();
  found.start.assign(1, 0);
  found.partner.clear();
  found.due.clear();
  found.slack.clear();
  auto pair = sorted_.cbegin();
  auto kept = remembered.begin();
  while (pair != sorted_.cend() || kept != remembered.end()) {
    const Index first =
        kept == remembered.end() || (pair != sorted_.cend() && pair->first <= *kept) ? pair->first : *kept;
    double slack = HUGE_VAL;
    for (; pair != sorted_.cend() && pair->first == first; ++pair) {
      found.partner.push_back(pair->second);
      found.due.push_back(pair->slack);
      slack = std::min(slack, pair->slack);
    }
    while (kept != remembered.end() && *kept == first) {
      ++kept;
    }
    found.owner.push_back(first);
    found.start.push_back(static_cast<Index>(found.partner.size()));
    found.slack.push_back(slack);
  }
  found.row_due = found.slack;
}

}  // namespace fexp::contact
