// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "quality/surfaces.hpp"

/// On which side of other bodies' surfaces nodes come out. Frames do not tell the way between them, so one is taken:
/// each node goes straight to its next place while the surface is held, and then, one after the other, the nodes of the
/// surface do. On that way every passage of the node through a triangle is counted without an error of rounding, +1
/// from the back to the front and -1 the other way. Through a closed surface the sum is the same on every way, as it is
/// the change of inside and outside. Through an open one it is that of the true way unless this goes round the rim
/// where the straight one does not, or the other way about.
namespace fexp::quality {

struct NodePassage {
  Index node{};
  Index body{};  ///< Whose surface was passed; another than the node's
  int sum{};     ///< Not 0
};

/// A triangle that moves, with the order in which its corners do: that of the numbers of their nodes.
struct MovingTriangle {
  std::array<Vec3d, 3> before;
  std::array<Vec3d, 3> after;
  std::array<Index, 3> node;
};

/// +1, 0 or -1: passages of a node that goes from one place to another through a triangle that moves. What would only
/// touch is decided by moving the node by (e, e^2, e^3) with an infinitely small e > 0.
[[nodiscard]] int sum_of_passages(const Vec3d& from, const Vec3d& to, const MovingTriangle& triangle);

/// The passages between two frames with positions `before` and `after`, shape [nodes] [length], through triangles that
/// are `alive`, shape [triangles]; ascending by body and node.
[[nodiscard]] std::vector<NodePassage> find_node_passages(const Surfaces& surfaces, std::span<const Vec3d> before,
                                                          std::span<const Vec3d> after, std::span<const char> alive);

}  // namespace fexp::quality
