// SPDX-License-Identifier: Apache-2.0
#include "contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index piece_blocks = 32;
constexpr Index node_grain = 4096;
constexpr std::size_t most_owned = 3 * at(model::block_lanes);

}  // namespace

void CandidateSearch::assign(const model::Model& model, std::span<const Index> bodies) {
  nodes_.clear();
  owned_.clear();
  first_owned_.assign(1, 0);
  std::vector<char> taken;
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    const auto first_local = static_cast<Index>(nodes_.size());
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      nodes_.push_back(n);
    }
    taken.assign(at(body.nodes.size()), 0);
    for (Index b = body.blocks.begin; b < body.blocks.end; ++b) {
      const model::ElementBlock& block = model.blocks[at(b)];
      for (Index e = block.first; e < block.first + block.count; ++e) {
        for (const Index n : model.triangle[at(e)]) {
          const Index in_body = n - body.nodes.begin;
          if (taken[at(in_body)] != 0) {
            continue;
          }
          taken[at(in_body)] = 1;
          const double reach = model.half_thickness[at(n)] + model::watch_margin(model.node_size[at(n)]);
          owned_.push_back({{}, reach * (1.0 + distance_rounding), n, first_local + in_body});
        }
      }
      first_owned_.push_back(static_cast<Index>(owned_.size()));
    }
  }
  pairs_.resize((first_owned_.size() - 1 + at(piece_blocks) - 1) / at(piece_blocks));
}

void CandidateSearch::search(const model::Model& model, const BlockPairs& near, const Positions& x, double skin,
                             std::span<const Index> remembered, Candidates& found) {
  take_nodes(x);
  const SearchGeometry geometry{x.motion, model.triangle.data(), model.half_thickness.data(), skin};
  parallel::for_each(static_cast<Index>(pairs_.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    for (Index i = piece * piece_blocks; i < std::min((piece + 1) * piece_blocks, near.count()); ++i) {
      try_block(model, near, x, geometry, i, pairs);
    }
  });
  fill_rows(remembered, found);
}

void CandidateSearch::take_nodes(const Positions& x) {
  parallel::for_each(static_cast<Index>(owned_.size()), node_grain, [&](Index k) {
    NearNode& node = owned_[at(k)];
    node.point = x(node.node);
  });
}

/// Appends the pairs of one block's elements.
void CandidateSearch::try_block(const model::Model& model, const BlockPairs& near, const Positions& x,
                                const SearchGeometry& geometry, Index index, std::vector<Pair>& pairs) const {
  const std::span<const Index> others = near.near(index);
  if (others.empty()) {
    return;
  }
  const model::ElementBlock& block = model.blocks[at(near.blocks()[at(index)])];
  const NearKernel& kernel = near_kernels().back();
  BlockTriangles triangles;  // NOLINT(cppcoreguidelines-pro-type-member-init): kernel.prepare fills it
  kernel.prepare(geometry, block, triangles);
  for (const Index other : others) {
    const NearNode* const nodes = &owned_[at(first_owned_[at(other)])];
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only what kernel.find has written is read
    std::array<NearPair, most_owned * at(model::block_lanes)> found;
    const Index count = kernel.find(triangles, nodes, first_owned_[at(other) + 1] - first_owned_[at(other)],
                                    geometry.skin, found.data());
    for (Index k = 0; k < count; ++k) {
      const NearPair& pair = found[at(k)];
      if (x.has(model, block.first + pair.lane)) {
        pairs.push_back({nodes[pair.node].local, block.first + pair.lane, pair.slack});
      }
    }
  }
}

/// Sorts the pairs by node; within a node they already ascend, because the pieces do.
void CandidateSearch::fill_rows(std::span<const Index> remembered, Candidates& found) {
  row_size_.assign(nodes_.size(), 0);
  for (const std::vector<Pair>& pairs : pairs_) {
    for (const Pair& pair : pairs) {
      ++row_size_[at(pair.local)];
    }
  }
  found.node.clear();
  found.start.assign(1, 0);
  std::size_t next = 0;
  for (std::size_t local = 0; local < nodes_.size(); ++local) {
    while (next < remembered.size() && remembered[next] < nodes_[local]) {
      ++next;
    }
    const bool kept = next < remembered.size() && remembered[next] == nodes_[local];
    if (row_size_[local] == 0 && !kept) {
      continue;
    }
    found.node.push_back(nodes_[local]);
    found.start.push_back(found.start.back() + row_size_[local]);
    // From now on the row of this node.
    row_size_[local] = static_cast<Index>(found.node.size()) - 1;
  }
  found.element.resize(at(found.start.back()));
  found.slack.assign(found.node.size(), HUGE_VAL);
  std::vector<Index> place(found.start.begin(), found.start.end() - 1);
  for (const std::vector<Pair>& pairs : pairs_) {
    for (const Pair& pair : pairs) {
      const std::size_t row = at(row_size_[at(pair.local)]);
      found.element[at(place[row]++)] = pair.element;
      found.slack[row] = std::min(found.slack[row], pair.slack);
    }
  }
}

}  // namespace fexp::contact
