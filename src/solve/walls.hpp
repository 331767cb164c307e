// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"

namespace fexp::solve {

/// Force of a rigid wall on a node, and its potential.
struct WallReaction {
  Vec3d force;         ///< [force]
  double energy{};     ///< 1/2 k g^2 [force*length]
  double stiffness{};  ///< k while the node touches, else 0; as much more as damping makes of it [force/length]
  Vec3d normal;        ///< Unit vector away from the wall; zero on the axis and in the centre
  double damping{};    ///< Coefficient of damping at a wall with mass [mass/time]
};

/// What touches a wall with mass, summed over nodes.
struct WallTouch {
  double stiffness{};  ///< [force/length]
  double damping{};    ///< [mass/time]
};

/// How far a node has come against the wall in a step.
struct WallSlip {
  Vec3d way;    ///< [length]
  double dt{};  ///< [time]; 0 where no step has been taken
};

/// Where the point of a wall without mass is at `time` [length]: it has moved by its displacement, or by the integral
/// of its velocity.
[[nodiscard]] Vec3d wall_point(const model::Model& model, const model::Wall& wall, double time) noexcept;

struct WallDistance {
  double distance{};  ///< Positive on the free side [length]
  Vec3d normal;       ///< Unit vector away from the wall; zero on the axis and in the centre
};

/// Distance of a position from a wall whose point is at `point`.
[[nodiscard]] WallDistance wall_distance(const model::Wall& wall, const Vec3d& point, const Vec3d& position) noexcept;

/// Penalty reaction of a wall whose point is at `point` on `node` at `position`: k (-g) along the normal while
/// g = distance - half thickness < 0.
[[nodiscard]] WallReaction wall_reaction(const model::Model& model, const model::Wall& wall, const Vec3d& point,
                                         Index node, const Vec3d& position) noexcept;

/// Adds friction and damping to what a wall with such does. `drag` is that of the step before, and becomes that of this
/// one [force]; where no step has been taken it acts as it is. Returns what is dissipated [force*length].
[[nodiscard]] double rub(const model::Model& model, const model::Wall& wall, const WallSlip& slip, Index node,
                         WallReaction& reaction, Vec3d& drag) noexcept;

/// Bound of omega^2 [1/time^2] of nodes that a wall with mass joins. `nodes2`: that of the nodes, were it heavy. With
/// springs k_i at masses m_i that share the mass M all omega^2 are eigenvalues of diag(k_i/m_i) + a a^T/M, a_i =
/// sqrt(k_i), and at most max k_i/m_i + sum k_i/M. Where there is damping the square of the sum of both frequencies is
/// a bound, each that in which a step of 2/omega is stable.
[[nodiscard]] double joined_frequency2(double nodes2, const WallTouch& touch, double inverse_mass) noexcept;

}  // namespace fexp::solve
