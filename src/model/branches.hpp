// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "model/topology.hpp"

/// Edges at which more than two triangles meet, as where a web stands on a flange. Of these the two that go on most
/// straightly are neighbours; for the others the surface ends there, see check_mesh.
namespace fexp::model {

/// Most triangles that may meet at an edge.
inline constexpr int most_at_edge = 8;

/// For each edge (3 x triangle + edge) the next one between the same nodes, round and round: itself at a free edge.
[[nodiscard]] std::vector<Index> edge_rounds(std::span<const Triangle> triangles);

/// For each corner (3 x triangle + corner) the fan that it belongs to, by the lowest corner of it: the triangles round
/// its node that are neighbours of neighbours across edges at the node.
[[nodiscard]] std::vector<Index> corner_fans(std::span<const Triangle> triangles, std::span<const Triangle> neighbours);

}  // namespace fexp::model
