// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/rigid_motion.hpp"
#include "solve/constraints.hpp"

/// Half-step central differences for a rigid body: its centre like a node, its rotation by the angular momentum.
namespace fexp::solve {

/// What acts on a rigid body from outside besides forces on its nodes: damping and conditions, over half a step.
struct RigidBooks {
  double work{};              ///< Of prescribed motion [force*length]
  double damping_work{};      ///< Taken out [force*length]
  double rotation_damping{};  ///< Of this what the rotation had [force*length]
  Vec3d impulse;              ///< [force*time]
  Vec3d angular_impulse;      ///< About the origin [force*length*time]
};

/// A half step of a run.
struct RigidHalf {
  HalfStep half{};
  double time{};     ///< At its end [time]
  double half_dt{};  ///< [time]
  double damping{};  ///< [1/time]
};

/// Energy of motion L . omega/2 of the rotation [force*length].
[[nodiscard]] double rotation_energy(const model::RigidBody& body, const model::RigidMotion& motion) noexcept;

/// v += dt/2 F/m and L += dt/2 T, damping, then prescribed velocities of the centre. The force has what is held
/// removed.
void kick_rigid(const model::Model& model, const model::RigidBody& body, const RigidHalf& half,
                model::RigidMotion& motion, RigidBooks& books);

/// Gives omega what the conditions want of it at the end of a half step, by a moment about the axes of the conditions.
void hold_rotation(const model::Model& model, const model::RigidBody& body, const RigidHalf& half,
                   model::RigidMotion& motion, RigidBooks& books);

/// Moves the body by a step and returns its mean rotation rate [1/time]. `half`: the opening half step before it. A
/// body that turns freely keeps its angular momentum, and its energy but for a bounded error of second order: the flow
/// is split into the turn of a body with three equal moments of inertia and turns about two principal axes, each exact
/// [decision 0018]. Otherwise the rate in the middle of the step is what turns it.
[[nodiscard]] Vec3d drift(const model::Model& model, const model::RigidBody& body, const RigidHalf& half,
                          model::RigidMotion& motion, RigidBooks& books);

/// dL/dt = T gives omega's rate J^-1 (T - omega x L), less what holds the rotation [1/time^2].
[[nodiscard]] Vec3d angular_acceleration(const model::RigidBody& body, const model::RigidMotion& motion,
                                         const Vec3d& rotation_rate) noexcept;

}  // namespace fexp::solve
