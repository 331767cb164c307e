// SPDX-License-Identifier: Apache-2.0
#include "contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index search_grain = 32;
constexpr Index block_grain = 512;
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
  found_.assign(first_owned_.size() - 1, {});
}

void CandidateSearch::search(const model::Model& model, const BlockPairs& pairs, const BlockWear& wear,
                             std::span<const Index> blocks, const Positions& x, double skin) {
  take_nodes(x, pairs.with_partners(blocks));
  const SearchGeometry geometry{x.motion, model.triangle.data(), model.half_thickness.data(), skin};
  parallel::for_each(static_cast<Index>(blocks.size()), search_grain,
                     [&](Index i) { try_block(model, pairs, wear, x, geometry, blocks[at(i)]); });
}

void CandidateSearch::take_nodes(const Positions& x, std::span<const Index> blocks) {
  parallel::for_each(static_cast<Index>(blocks.size()), block_grain, [&](Index i) {
    const std::size_t block = at(blocks[at(i)]);
    for (Index k = first_owned_[block]; k < first_owned_[block + 1]; ++k) {
      NearNode& node = owned_[at(k)];
      node.point = x(node.node);
    }
  });
}

/// Finds the pairs of one block's elements.
void CandidateSearch::try_block(const model::Model& model, const BlockPairs& pairs, const BlockWear& wear,
                                const Positions& x, const SearchGeometry& geometry, Index index) {
  std::vector<Pair>& found = found_[at(index)];
  leave_out_due(pairs, wear, index, found);
  const model::ElementBlock& block = model.blocks[at(pairs.blocks()[at(index)])];
  const NearKernel& kernel = near_kernels().back();
  BlockTriangles triangles;  // NOLINT(cppcoreguidelines-pro-type-member-init): kernel.prepare fills it
  bool ready = false;
  const IndexRange partners = pairs.partners_of(index);
  for (Index p = partners.begin; p < partners.end; ++p) {
    if (!wear.is_due_and_near(p)) {
      continue;
    }
    if (!ready) {
      kernel.prepare(geometry, block, triangles);
      ready = true;
    }
    const Index partner = pairs.partners()[at(p)];
    const NearNode* const nodes = owned_.data() + first_owned_[at(partner)];
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): only what kernel.find has written is read
    std::array<NearPair, most_owned * at(model::block_lanes)> near;
    const Index count = kernel.find(triangles, nodes, first_owned_[at(partner) + 1] - first_owned_[at(partner)],
                                    geometry.skin, near.data());
    for (Index k = 0; k < count; ++k) {
      const NearPair& pair = near[at(k)];
      if (x.has(model, block.first + pair.lane)) {
        found.push_back({nodes[pair.node].local, block.first + pair.lane, partner, pair.slack});
      }
    }
  }
}

/// Sorts the pairs by node; within a node they already ascend, because the blocks do.
void CandidateSearch::list(const BlockPairs& pairs, const BlockWear& wear, std::span<const Index> remembered,
                           CandidateRows& found) {
  row_size_.assign(nodes_.size(), 0);
  for_each_found(pairs, wear, found_, [&](const Pair& pair, double) { ++row_size_[at(pair.local)]; });
  found.owner.clear();
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
    found.owner.push_back(nodes_[local]);
    found.start.push_back(found.start.back() + row_size_[local]);
    // From now on the row of this node.
    row_size_[local] = static_cast<Index>(found.owner.size()) - 1;
  }
  found.partner.resize(at(found.start.back()));
  found.due.resize(at(found.start.back()));
  found.slack.assign(found.owner.size(), HUGE_VAL);
  std::vector<Index> place(found.start.begin(), found.start.end() - 1);
  for_each_found(pairs, wear, found_, [&](const Pair& pair, double slack) {
    const std::size_t row = at(row_size_[at(pair.local)]);
    const std::size_t i = at(place[row]++);
    found.partner[i] = pair.element;
    found.due[i] = slack;
    found.slack[row] = std::min(found.slack[row], slack);
  });
  found.row_due = found.slack;
}

}  // namespace fexp::contact
