// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "quality/surfaces.hpp"

namespace fexp::quality {

/// An edge that goes through a triangle of which it has no node.
struct EdgeCut {
  Index edge{};
  Index triangle{};

  friend constexpr bool operator==(const EdgeCut&, const EdgeCut&) = default;
  friend constexpr bool operator<(const EdgeCut& a, const EdgeCut& b) noexcept {
    return a.edge != b.edge ? a.edge < b.edge : a.triangle < b.triangle;
  }
};

/// Whether the segment p q goes through the triangle. It does when its ends are strictly on both sides of the plane,
/// and meets the triangle in between, the rim included: where it passes exactly between two triangles it goes through
/// both. What lies in the plane, or ends in it, only touches. Decided without an error of rounding.
[[nodiscard]] bool goes_through(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& triangle);

/// All cuts of mid-surfaces at the `position`s, shape [nodes] [length], ascending. Triangles that are not alive, shape
/// [triangles], and edges of none that is, are left out. A body is held against itself as well.
[[nodiscard]] std::vector<EdgeCut> find_edge_cuts(const Surfaces& surfaces, std::span<const Vec3d> position,
                                                  std::span<const char> alive);

}  // namespace fexp::quality
