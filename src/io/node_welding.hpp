// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

namespace fexp::io {

/// Points that were made one.
struct WeldedNodes {
  std::vector<Vec3d> position;  ///< [length], shape [nodes]
  std::vector<Index> node;      ///< Node of each point, shape [points].
};

/// Makes one node of points that lie within `tolerance` [length] of each other. Points are taken in order: each joins
/// the first node within the tolerance, or else becomes a node itself, so the result follows from the points' order
/// alone. A negative tolerance stands for 1e-6 of the bounding box diagonal.
[[nodiscard]] WeldedNodes weld_nodes(const std::vector<Vec3d>& points, double tolerance);

}  // namespace fexp::io
