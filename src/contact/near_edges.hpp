// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"

/// The inner loop of a search: edges against the edges of one block, compiled for several instruction sets.
namespace fexp::contact {

/// An edge that is looked for.
struct NearEdge {
  Vec3d begin;          ///< [length]
  Vec3d end;            ///< [length]
  double reach{};       ///< See edge_reach [length]
  double half_reach{};  ///< That and half the skin, by which its box is grown [length]
  std::array<Index, 2> node{};
  Index number{};

  [[nodiscard]] Box box() const noexcept {
    Box box{begin, begin};
    box.include(end);
    return box.grown(half_reach);
  }
};

/// Most edges of a block.
inline constexpr Index most_edges = 3 * model::block_lanes;

/// Rows of BlockEdges.
enum EdgeRow : Index {
  edge_row_begin = 0,      // x, y, z [length]
  edge_row_along = 3,      // x, y, z, from begin to end [length]
  edge_row_low = 6,        // Boxes [length]
  edge_row_high = 9,       // Empty ones in lanes without an edge
  edge_row_inverse2 = 12,  // 1 / along^2; 0 where that is 0 [1/length^2]
  edge_row_reach = 13,     // [length]
  edge_row_node = 14,      // Numbers of the ends
  edge_row_number = 16,
  edge_rows = 17
};

/// The edges of a block, one in each lane, made ready to be asked for many others.
struct alignas(64) BlockEdges {
  std::array<std::array<double, at(most_edges)>, at(edge_rows)> rows;
  Box box;  ///< Of all of them
  Index count{};
};

/// An edge of the block and one of those asked for: no closer to each other than both reach by `slack` [length].
struct NearEdgePair {
  Index lane;
  Index edge;  ///< Into the edges given
  double slack;
};

/// Makes the edges of a block ready, of which there are `most_edges` at most.
void make_ready(std::span<const NearEdge> edges, BlockEdges& block) noexcept;

/// Writes the pairs of an edge of the block and one of the `count` given that has a higher number and none of its
/// nodes, and whose slack is at most the skin, to `found`, which has room for `most_edges` for each edge given; returns
/// how many there are.
using NearEdgeKernel = Index (*)(const BlockEdges& block, const NearEdge* edges, Index count, double skin,
                                 NearEdgePair* found) noexcept;

/// Kernels that this processor runs, the widest last. All find the same pairs.
[[nodiscard]] std::span<const NearEdgeKernel> near_edge_kernels();

}  // namespace fexp::contact
