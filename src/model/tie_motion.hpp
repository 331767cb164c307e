// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"

/// How tied nodes move with their carriers. The arm is no part of the state: it is where the node is less the point of
/// its carriers.
namespace fexp::model {

/// Mean rates of the carriers by their weights; zero where these are held.
struct TieRates {
  Vec3d velocity;       ///< [length/time]
  Vec3d rotation_rate;  ///< [1/time]
};

[[nodiscard]] inline TieRates rates_at_carriers(const Tie& tie, const State& state) noexcept {
  TieRates rates;
  for (std::size_t a = 0; a < 3 && !tie.held; ++a) {
    const NodeMotion& carrier = state.motion[at(tie.carrier[a])];
    rates.velocity += tie.weight[a] * carrier.velocity;
    rates.rotation_rate += tie.weight[a] * carrier.rotation_rate;
  }
  return rates;
}

/// From the carriers' point to the node [length]; nothing but rounding, which is left out, where the arm has no length.
[[nodiscard]] inline Vec3d arm_of(const Tie& tie, const State& state) noexcept {
  if (!(tie.length > 0.0)) {
    return {};
  }
  Vec3d arm = state.motion[at(tie.node)].position;
  for (std::size_t a = 0; a < 3; ++a) {
    arm -= tie.weight[a] * state.motion[at(tie.carrier[a])].position;
  }
  return arm;
}

/// Calls `add(node, mass, inertia)` for what a tie hands to each of its carriers.
template <class Add>
void for_each_handed(const Model& model, const Tie& tie, const Add& add) {
  if (tie.held || tie.rigid != no_index) {
    return;
  }
  const double mass = model.mass[at(tie.node)], inertia = tie.rotations ? model.inertia[at(tie.node)] : 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    add(tie.carrier[a], tie.weight[a] * mass, tie.weight[a] * (inertia + mass * tie.length * tie.length));
  }
}

/// Velocity and rotation rate of a tied node between steps, where its carriers have theirs.
inline void rate_tied_node(const Tie& tie, State& state) noexcept {
  const TieRates rates = rates_at_carriers(tie, state);
  NodeMotion& node = state.motion[at(tie.node)];
  node.velocity = rates.velocity + cross(rates.rotation_rate, arm_of(tie, state));
  if (tie.rotations) {
    node.rotation_rate = rates.rotation_rate;
  }
}

/// The arm after a turn about `angle`, a vector [rad]: by the rotation r' - r = angle x (r + r')/2, which needs no
/// sines and in which the velocity of the arm's end is that of the turn at the mean of both arms; its angle is 2
/// atan(angle/2). The length is that of the reference.
[[nodiscard]] inline Vec3d turned_arm(const Tie& tie, const Vec3d& arm, const Vec3d& angle) noexcept {
  if (!(tie.length > 0.0)) {
    return {};
  }
  const Vec3d half = 0.5 * angle;
  const Vec3d first = arm + cross(half, arm);
  const Vec3d turned = arm + (2.0 / (1.0 + dot(half, half))) * cross(half, first);
  return (tie.length / norm(turned)) * turned;
}

}  // namespace fexp::model
