// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/topology.hpp"

namespace fexp::model {

/// Puts triangles of one section that lie near each other next to each other: halved again and again along the longest
/// extent of their centres until each piece is a patch. `order` has the indices to be put in order; those of a single
/// patch stay as they are.
void order_by_place(const std::vector<Vec3d>& position, const std::vector<Triangle>& triangle, std::span<Index> order);

/// Numbers nodes in the order in which `triangle` meets them, so that those of triangles near each other are near each
/// other too, however a mesh file numbers them; nodes of no triangle come last. Returns the new number of each node,
/// shape [nodes]. For triangles of a single patch the numbers stay as they are.
[[nodiscard]] std::vector<Index> node_numbers(std::size_t nodes, std::span<const Triangle> triangle);

}  // namespace fexp::model
