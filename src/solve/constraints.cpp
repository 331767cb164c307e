// SPDX-License-Identifier: Apache-2.0
#include "solve/constraints.hpp"

namespace fexp::solve {

namespace {

template <class Vector>
auto* component(Vector& v, int dof) noexcept {
  switch (dof % 3) {
    case 0:
      return &v.x;
    case 1:
      return &v.y;
    default:
      return &v.z;
  }
}

/// Books the reaction that a change of acceleration stands for.
void book_reaction(const model::Model& model, const model::State& state, Index node, const Vec3d& linear,
                   const Vec3d& angular, BodyActions& actions) {
  const Vec3d force = moving_mass(model, state, node) * linear;
  actions.force += force;
  actions.moment += cross(state.motion[at(node)].position, force) + moving_inertia(model, state, node) * angular;
}

}  // namespace

double prescribed_velocity(const model::Model& model, const model::PrescribedNode& p, double start, double way,
                           HalfStep half, double time, double half_dt) {
  switch (p.kind) {
    case model::PrescribedKind::velocity:
      return curve_value(model, p.curve, time) * p.value;
    case model::PrescribedKind::acceleration:
      return start + curve_integral(model, p.curve, time) * p.value;
    case model::PrescribedKind::displacement:
      break;
  }
  if (half == HalfStep::closing) {
    return curve_slope(model, p.curve, time) * p.value;
  }
  const double goal = curve_value(model, p.curve, time + half_dt) * p.value;
  const double reached = p.angular() ? curve_value(model, p.curve, time - half_dt) * p.value : way;
  return (goal - reached) / (half_dt + half_dt);
}

PrescribedReport prescribe_velocities(const model::Model& model, model::State& state, Index body, HalfStep half,
                                      double time, double half_dt, double damping) {
  const double kept = 1.0 / (1.0 + damping * half_dt);
  PrescribedReport report;
  const IndexRange range = model.bodies[at(body)].prescribed;
  for (Index i = range.begin; i < range.end; ++i) {
    const model::PrescribedNode& p = model.prescribed[at(i)];
    model::NodeMotion& motion = state.motion[at(p.node)];
    model::NodeAcceleration& acceleration = state.acceleration[at(p.node)];
    Vec3d& rate = p.dof < 3 ? motion.velocity : motion.rotation_rate;
    const Vec3d& change = p.dof < 3 ? acceleration.linear : acceleration.angular;
    const double inertia = p.dof < 3 ? moving_mass(model, state, p.node) : moving_inertia(model, state, p.node);
    const double present = p.oblique ? dot(rate, p.direction) : *component(rate, p.dof);
    const double kick = half_dt * (p.oblique ? dot(change, p.direction) : *component(change, p.dof));
    const double undamped = present / kept, before = undamped - kick;
    const Vec3d& start = p.angular() ? model.initial_rotation_rate[at(p.node)] : model.initial_velocity[at(p.node)];
    const double way = dot(motion.position - model.reference_position[at(p.node)], p.direction);
    const double after = prescribed_velocity(model, p, dot(start, p.direction), way, half, time, half_dt);
    const double middle = half == HalfStep::opening ? after : before;
    const double damped = 0.5 * inertia * (1.0 - kept * kept) * undamped * undamped;
    report.work += 0.5 * inertia * (after - before) * (after + before) - inertia * kick * middle + damped;
    const Vec3d impulse = (inertia * (after - present)) * p.direction;
    if (p.dof < 3) {
      report.impulse += impulse;
      report.angular_impulse += cross(motion.position, impulse);
    } else {
      report.angular_impulse += impulse;
    }
    if (p.oblique) {
      rate += (after - present) * p.direction;
    } else {
      *component(rate, p.dof) = after;
    }
  }
  return report;
}

void hold_constraints(const model::Model& model, model::State& state, Index body_index, BodyActions& actions) {
  const model::Body& body = model.bodies[at(body_index)];
  for (Index i = body.fixed.begin; i < body.fixed.end; ++i) {
    const model::FixedNode& fixed = model.fixed[at(i)];
    model::NodeAcceleration& acceleration = state.acceleration[at(fixed.node)];
    const model::NodeAcceleration before = acceleration;
    for (int dof = 0; dof < 6; ++dof) {
      if ((fixed.mask >> dof & 1) != 0) {
        *component(dof < 3 ? acceleration.linear : acceleration.angular, dof) = 0.0;
      }
    }
    book_reaction(model, state, fixed.node, acceleration.linear - before.linear, acceleration.angular - before.angular,
                  actions);
  }
  for (Index i = body.symmetry.begin; i < body.symmetry.end; ++i) {
    const model::SymmetryNode& symmetry = model.symmetry[at(i)];
    model::NodeAcceleration& acceleration = state.acceleration[at(symmetry.node)];
    const model::NodeAcceleration before = acceleration;
    const Vec3d& n = symmetry.normal;
    acceleration.linear -= dot(acceleration.linear, n) * n;
    acceleration.angular = dot(acceleration.angular, n) * n;
    book_reaction(model, state, symmetry.node, acceleration.linear - before.linear,
                  acceleration.angular - before.angular, actions);
  }
  for (Index i = body.oblique.begin; i < body.oblique.end; ++i) {
    const model::ObliqueNode& oblique = model.oblique[at(i)];
    model::NodeAcceleration& acceleration = state.acceleration[at(oblique.node)];
    const model::NodeAcceleration before = acceleration;
    Vec3d& held = oblique.angular ? acceleration.angular : acceleration.linear;
    held -= dot(held, oblique.direction) * oblique.direction;
    book_reaction(model, state, oblique.node, acceleration.linear - before.linear,
                  acceleration.angular - before.angular, actions);
  }
}

}  // namespace fexp::solve
