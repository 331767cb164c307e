// SPDX-License-Identifier: Apache-2.0
#include "solve/rigid_laws.hpp"

#include <array>
#include <cstddef>

namespace fexp::solve {

namespace {

using model::RigidBody;
using model::RigidMotion;

/// Axes, at most three and orthogonal, about which omega has to have given components.
struct Axes {
  std::array<Vec3d, 3> direction{};
  std::array<double, 3> rate{};
  std::size_t count{};

  void add(const Vec3d& axis, double value) noexcept {
    direction[count] = axis;
    rate[count++] = value;
  }
};

Axes conditions(const model::Model& model, const RigidBody& body, const RigidHalf& half) {
  Axes axes;
  for (const Vec3d& direction : body.held_rotations) {
    axes.add(direction, 0.0);
  }
  for (const model::PrescribedNode& p : body.prescribed) {
    if (p.angular()) {
      axes.add(p.direction, prescribed_velocity(model, p, dot(body.initial_rotation_rate, p.direction), 0.0, half.half,
                                                half.time, half.half_dt));
    }
  }
  return axes;
}

/// The vector in the span of the axes that, added to `vector`, makes J^-1 times it have the given components: by
/// Gaussian elimination of a positive definite matrix, which needs no pivots.
Vec3d correction(const RigidBody& body, const Quaternion& orientation, const Axes& axes, const Vec3d& vector) noexcept {
  std::array<std::array<double, 3>, 3> a{};
  std::array<double, 3> b{};
  const Vec3d rate = inverse_inertia_times(body, orientation, vector);
  for (std::size_t j = 0; j < axes.count; ++j) {
    const Vec3d column = inverse_inertia_times(body, orientation, axes.direction[j]);
    for (std::size_t i = 0; i < axes.count; ++i) {
      a[i][j] = dot(axes.direction[i], column);
    }
    b[j] = axes.rate[j] - dot(axes.direction[j], rate);
  }
  for (std::size_t k = 0; k < axes.count; ++k) {
    for (std::size_t i = k + 1; i < axes.count; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < axes.count; ++j) {
        a[i][j] -= factor * a[k][j];
      }
      b[i] -= factor * b[k];
    }
  }
  Vec3d sum;
  for (std::size_t k = axes.count; k-- > 0;) {
    for (std::size_t j = k + 1; j < axes.count; ++j) {
      b[k] -= a[k][j] * b[j];
    }
    b[k] /= a[k][k];
    sum += b[k] * axes.direction[k];
  }
  return sum;
}

/// The exact flow of a free body for energies that split: |L|^2/(2 J2) turns it about L, which commutes with the
/// others; (1/Ji - 1/J2) li^2/2 turns it about its principal axis i, for i = 1 and 3.
void turn_freely(const RigidBody& body, double dt, RigidMotion& motion) noexcept {
  const Vec3d& momentum = motion.angular_momentum;
  const double middle = 1.0 / body.inertia[1];
  Quaternion q = rotation_by((dt * middle) * momentum) * motion.orientation;
  const auto about = [&](std::size_t i, double time) {
    const double component = dot(body.axis[i], rotated(inverse(q), momentum));
    q = unit(q * rotation_by((time * (1.0 / body.inertia[i] - middle) * component) * body.axis[i]));
  };
  q = unit(q);
  about(0, 0.5 * dt);
  about(2, dt);
  about(0, 0.5 * dt);
  motion.orientation = q;
}

}  // namespace

double rotation_energy(const RigidBody& body, const RigidMotion& motion) noexcept {
  return 0.5 * dot(motion.angular_momentum, inverse_inertia_times(body, motion.orientation, motion.angular_momentum));
}

void kick_rigid(const model::Model& model, const RigidBody& body, const RigidHalf& half, RigidMotion& motion,
                RigidBooks& books) {
  motion.velocity += (half.half_dt / body.mass) * motion.force;
  motion.angular_momentum += half.half_dt * motion.moment;
  const double kept = 1.0 / (1.0 + half.damping * half.half_dt);
  if (half.damping > 0.0) {
    if (!body.held_rotations.empty() && !body.prescribes_rotation) {
      // There is no motion about these, of which damping could take anything.
      hold_rotation(model, body, half, motion, books);
    }
    const Vec3d lost = (body.mass * (kept - 1.0)) * motion.velocity;
    books.impulse += lost;
    books.angular_impulse += cross(motion.centre, lost) + (kept - 1.0) * motion.angular_momentum;
    const double rotation = (1.0 - kept * kept) * rotation_energy(body, motion);
    books.rotation_damping += rotation;
    books.damping_work += 0.5 * (1.0 - kept * kept) * body.mass * dot(motion.velocity, motion.velocity) + rotation;
    motion.velocity = kept * motion.velocity;
    motion.angular_momentum = kept * motion.angular_momentum;
  }
  for (const model::PrescribedNode& p : body.prescribed) {
    if (p.angular()) {
      continue;
    }
    const double present = dot(motion.velocity, p.direction);
    const double change = half.half_dt / body.mass * dot(motion.force, p.direction);
    const double undamped = present / kept, before = undamped - change;
    const double after =
        prescribed_velocity(model, p, dot(body.initial_velocity, p.direction),
                            dot(motion.centre - body.centre, p.direction), half.half, half.time, half.half_dt);
    const double middle = half.half == HalfStep::opening ? after : before;
    const double damped = 0.5 * body.mass * (1.0 - kept * kept) * undamped * undamped;
    books.work += 0.5 * body.mass * (after - before) * (after + before) - body.mass * change * middle + damped;
    const Vec3d impulse = (body.mass * (after - present)) * p.direction;
    books.impulse += impulse;
    books.angular_impulse += cross(motion.centre, impulse);
    motion.velocity += (after - present) * p.direction;
  }
}

void hold_rotation(const model::Model& model, const RigidBody& body, const RigidHalf& half, RigidMotion& motion,
                   RigidBooks& books) {
  const Vec3d impulse = correction(body, motion.orientation, conditions(model, body, half), motion.angular_momentum);
  motion.angular_momentum += impulse;
  books.angular_impulse += impulse;
}

Vec3d drift(const model::Model& model, const RigidBody& body, const RigidHalf& half, RigidMotion& motion,
            RigidBooks& books) {
  const double dt = half.half_dt + half.half_dt;
  motion.centre += dt * motion.velocity;
  if (body.turns_freely) {
    const Vec3d before = rotation_rate(body, motion);
    turn_freely(body, dt, motion);
    return 0.5 * (before + rotation_rate(body, motion));
  }
  const Quaternion start = motion.orientation;
  hold_rotation(model, body, half, motion, books);
  motion.orientation = unit(rotation_by(half.half_dt * rotation_rate(body, motion)) * start);
  hold_rotation(model, body, half, motion, books);
  const Vec3d rate = rotation_rate(body, motion);
  motion.orientation = unit(rotation_by(dt * rate) * start);
  return rate;
}

Vec3d angular_acceleration(const RigidBody& body, const RigidMotion& motion, const Vec3d& rate) noexcept {
  Axes held;
  for (const Vec3d& direction : body.held_rotations) {
    held.add(direction, 0.0);
  }
  const Vec3d moment = motion.moment - cross(rate, motion.angular_momentum);
  const Vec3d sum = moment + correction(body, motion.orientation, held, moment);
  return model::without(body.held_rotations, inverse_inertia_times(body, motion.orientation, sum));
}

}  // namespace fexp::solve
