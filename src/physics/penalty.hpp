// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp::physics {

/// A contact spring at some depth.
struct Penalty {
  double energy{};     ///< [force*length]
  double force{};      ///< [force]
  double stiffness{};  ///< Slope of the force [force/length]
};

/// A spring that hardens: with x the depth over the full contact distance, its energy is k g^2/2 (1 + h x^2) up to
/// x = 1, where the mid-surfaces meet. Behind that the slope of the force stays as it is. h = 0 gives the linear
/// penalty of [REK19]. `full`: contact distance by the thicknesses alone [length]; 0: linear.
[[nodiscard]] inline Penalty penalty_of(double stiffness, double hardening, double depth, double full) noexcept {
  if (!(full > 0.0) || !(hardening > 0.0)) {
    return {0.5 * stiffness * depth * depth, stiffness * depth, stiffness};
  }
  const double within = depth < full ? depth : full, part = within / full, grown = hardening * part * part;
  Penalty p;
  p.energy = 0.5 * stiffness * within * within * (1.0 + grown);
  p.force = stiffness * within * (1.0 + 2.0 * grown);
  p.stiffness = stiffness * (1.0 + 6.0 * grown);
  const double beyond = depth - within;
  p.energy += beyond * (p.force + 0.5 * p.stiffness * beyond);
  p.force += p.stiffness * beyond;
  return p;
}

}  // namespace fexp::physics
