// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/quaternion.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Motion of a rigid body at a step boundary, and what acts on it there.
struct RigidMotion {
  Vec3d centre;            ///< Of mass [length]
  Vec3d velocity;          ///< [length/time]
  Quaternion orientation;  ///< From the reference configuration
  Vec3d angular_momentum;  ///< About the centre, in the axes of the model [mass*length^2/time]
  Vec3d force;             ///< At the centre, less what holds the body [force]
  Vec3d moment;            ///< About the centre [force*length]
};

/// J^-1 of the turned body times a vector.
[[nodiscard]] inline Vec3d inverse_inertia_times(const RigidBody& body, const Quaternion& orientation,
                                                 const Vec3d& vector) noexcept {
  const Vec3d inner = rotated(inverse(orientation), vector);
  Vec3d result;
  for (std::size_t i = 0; i < 3; ++i) {
    result += (dot(body.axis[i], inner) / body.inertia[i]) * body.axis[i];
  }
  return rotated(orientation, result);
}

/// J of the body in the reference configuration times a vector.
[[nodiscard]] inline Vec3d inertia_times(const RigidBody& body, const Vec3d& vector) noexcept {
  Vec3d result;
  for (std::size_t i = 0; i < 3; ++i) {
    result += (body.inertia[i] * dot(body.axis[i], vector)) * body.axis[i];
  }
  return result;
}

/// Removes what lies along orthogonal unit vectors.
[[nodiscard]] inline Vec3d without(const std::vector<Vec3d>& held, Vec3d vector) noexcept {
  for (const Vec3d& direction : held) {
    vector -= dot(vector, direction) * direction;
  }
  return vector;
}

/// omega = J^-1 L, and to the bit none of it about axes that are held [1/time].
[[nodiscard]] inline Vec3d rotation_rate(const RigidBody& body, const RigidMotion& motion) noexcept {
  return without(body.held_rotations, inverse_inertia_times(body, motion.orientation, motion.angular_momentum));
}

/// Velocity of the body's point that is at a position [length/time].
[[nodiscard]] inline Vec3d velocity_at(const RigidMotion& motion, const Vec3d& rotation_rate,
                                       const Vec3d& position) noexcept {
  return motion.velocity + cross(rotation_rate, position - motion.centre);
}

}  // namespace fexp::model
