// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

/// The inner loop of a search: nodes against the triangles of one block, compiled for several instruction sets.
namespace fexp::contact {

/// A node that is looked for, and how far it reaches: half its thickness and the margin up to which it is watched.
struct NearNode {
  Vec3d point;     ///< [length]
  double reach{};  ///< [length]
  Index node{};
  Index local{};  ///< Into CandidateSearch::nodes
};

/// Rows of BlockTriangles. Edge a leads from corner a to corner a + 1.
enum BlockRow : Index {
  row_corner = 0,            // x, y, z of corners [length]
  row_edge = 9,              // x, y, z of edges [length]
  row_inward = 18,           // Vectors in the plane, normal to edges, that point inwards [length^3]
  row_normal = 27,           // [length^2]
  row_inverse_edge2 = 30,    // 1 / edge^2; 0 where there is none [1/length^2]
  row_inverse_normal2 = 33,  // 1 / normal^2; 0 where there is none [1/length^4]
  row_low = 34,              // Boxes grown by half thickness and skin [length]
  row_high = 37,
  row_watched = 40,      // Half thickness, and a little for rounding [length]
  row_node = 41,         // Numbers of the corners
  row_bound_scale = 44,  // 0.98 / normal^2; 0 for slivers, whose normals are too inaccurate for a bound [1/length^4]
  block_rows = 45
};

/// The triangles of a block made ready to be asked for many nodes. Lanes without a triangle repeat the last one.
struct alignas(64) BlockTriangles {
  std::array<std::array<double, at(model::block_lanes)>, at(block_rows)> rows;
  Index count{};
};

/// A node of those asked for and a triangle of the block: no closer to each other than watched by `slack` [length].
struct NearPair {
  Index node;  ///< Into the nodes given
  Index lane;
  double slack;
};

struct SearchGeometry {
  const model::NodeMotion* motion{};       // [nodes]
  const std::array<Index, 3>* triangle{};  // [elements]
  const double* half_thickness{};          // [nodes] [length]
  double skin{};                           ///< [length]
};

/// Distances are rounded; a pair on the very border is taken.
inline constexpr double distance_rounding = 1.0e-9;

/// Loops over the triangles of a block. All versions find the same pairs.
struct NearKernel {
  /// Makes the block's triangles ready in the present geometry.
  void (*prepare)(const SearchGeometry& geometry, const model::ElementBlock& block, BlockTriangles& triangles) noexcept;
  /// Writes the pairs of `count` nodes whose slack is at most the skin to `found`, which has room for block_lanes for
  /// each node, and returns how many there are. Triangles ascend for each node; corners of a triangle are no pairs with
  /// it.
  Index (*find)(const BlockTriangles& triangles, const NearNode* nodes, Index count, double skin,
                NearPair* found) noexcept;
};

/// Kernels that this processor runs, the widest last.
[[nodiscard]] std::span<const NearKernel> near_kernels();

}  // namespace fexp::contact
