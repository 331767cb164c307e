// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/vec3.hpp"

namespace fexp::physics {

/// What a contact pair does besides the penalty of its depth.
struct DragLaw {
  double friction{};  ///< Coulomb's coefficient [-]
  double damping{};   ///< Part of the critical damping of the pair in the normal direction [-]

  [[nodiscard]] constexpr bool acts() const noexcept { return friction > 0.0 || damping > 0.0; }
  /// By how much damping raises the frequency that a step has to follow: omega^2 times this [BLM00, chapter 6].
  [[nodiscard]] double frequency2_factor() const noexcept {
    const double root = 1.0 / (std::sqrt(1.0 + damping * damping) - damping);
    return root * root;
  }
};

/// A pair in one step: its second side (the node, the second edge) against its first.
struct DragPair {
  Vec3d normal;           ///< Unit vector, direction of the penalty force on the second side
  double normal_force{};  ///< Penalty force [force]
  double stiffness{};     ///< Of the penalty, and of sticking [force/length]
  double inverse_mass{};  ///< 1/m of the two sides together [1/mass]
  Vec3d way;              ///< Of the second side relative to the first in the step [length]
  double dt{};            ///< [time]
};

struct Drag {
  Vec3d force;          ///< On the second side [force]
  double stored{};      ///< Energy of sticking [force*length]
  double dissipated{};  ///< In this step, by slip and damping [force*length]
};

/// The part of a vector along the surface.
[[nodiscard]] inline Vec3d tangential(const Vec3d& v, const Vec3d& normal) noexcept {
  return v - dot(v, normal) * normal;
}

/// Energy of sticking that a drag holds [force*length].
[[nodiscard]] inline double stored_energy(const Vec3d& drag, const Vec3d& normal, double stiffness) noexcept {
  const Vec3d along = tangential(drag, normal);
  return 0.5 * dot(along, along) / stiffness;
}

/// Friction by return mapping [W06]: the force of the step before, turned into the present tangent plane,
/// grows by stiffness times way as long as the sides stick, and is brought back to Coulomb's limit where they slip.
/// Damping opposes the normal velocity; it does not pull. Work is that of the mean of both steps' forces on the way, so
/// that sticking dissipates nothing to the last bit.
[[nodiscard]] inline Drag drag_of(const DragLaw& law, const DragPair& pair, const Vec3d& before) noexcept {
  const double way_along_normal = dot(pair.way, pair.normal);
  double damping = 0.0;
  if (law.damping > 0.0) {
    const double coefficient = 2.0 * law.damping * std::sqrt(pair.stiffness / pair.inverse_mass);
    damping = -coefficient * way_along_normal / pair.dt;
    damping = damping < -pair.normal_force ? -pair.normal_force : damping;
  }
  Vec3d friction;
  if (law.friction > 0.0) {
    const Vec3d old = tangential(before, pair.normal);
    friction = old - pair.stiffness * (pair.way - way_along_normal * pair.normal);
    const double limit = law.friction * (pair.normal_force + damping), size2 = dot(friction, friction);
    if (size2 > limit * limit) {
      friction = (limit / std::sqrt(size2)) * friction;
    }
  }
  Drag drag;
  drag.force = friction + damping * pair.normal;
  drag.stored = stored_energy(drag.force, pair.normal, pair.stiffness);
  drag.dissipated =
      stored_energy(before, pair.normal, pair.stiffness) - drag.stored - 0.5 * dot(before + drag.force, pair.way);
  return drag;
}

}  // namespace fexp::physics
