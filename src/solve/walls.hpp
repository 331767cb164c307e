// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"

namespace fexp::solve {

/// Force of a rigid wall on a node, and its potential.
struct WallReaction {
  Vec3d force;         ///< [force]
  double energy{};     ///< 1/2 k g^2 [force*length]
  double stiffness{};  ///< k while the node touches, else 0 [force/length]
};

/// Where the wall's point is at `time` [length]: it has moved by its displacement, or by the integral of its velocity.
[[nodiscard]] Vec3d wall_point(const model::Model& model, const model::Wall& wall, double time) noexcept;

/// Penalty reaction of a wall whose point is at `point` on `node` at `position`: k (-g) along the normal while
/// g = distance - half thickness < 0.
[[nodiscard]] WallReaction wall_reaction(const model::Model& model, const model::Wall& wall, const Vec3d& point,
                                         Index node, const Vec3d& position) noexcept;

}  // namespace fexp::solve
