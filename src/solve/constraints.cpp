// SPDX-License-Identifier: Apache-2.0
#include "solve/constraints.hpp"

namespace fexp::solve {

namespace {

double* component(Vec3d& linear, Vec3d& angular, int dof) noexcept {
  Vec3d& v = dof < 3 ? linear : angular;
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
  const Vec3d force = model.mass[at(node)] * linear;
  actions.force += force;
  actions.moment += cross(state.motion[at(node)].position, force) + model.inertia[at(node)] * angular;
}

}  // namespace

PrescribedReport prescribe_velocities(const model::Model& model, model::State& state, Index body, HalfStep half,
                                      double time, double half_dt) {
  PrescribedReport report;
  const IndexRange range = model.bodies[at(body)].prescribed;
  for (Index i = range.begin; i < range.end; ++i) {
    const model::PrescribedNode& p = model.prescribed[at(i)];
    model::NodeMotion& motion = state.motion[at(p.node)];
    model::NodeAcceleration& acceleration = state.acceleration[at(p.node)];
    double* velocity = component(motion.velocity, motion.rotation_rate, p.dof);
    const double inertia = p.dof < 3 ? model.mass[at(p.node)] : model.inertia[at(p.node)];
    const double kick = half_dt * *component(acceleration.linear, acceleration.angular, p.dof);
    const double before = *velocity - kick;
    const double after = curve_value(model, p.curve, time) * p.velocity;
    const double middle = half == HalfStep::opening ? after : before;
    report.work += 0.5 * inertia * (after - before) * (after + before) - inertia * kick * middle;
    Vec3d linear, angular;
    *component(linear, angular, p.dof) = inertia * (after - *velocity);
    report.impulse += linear;
    report.angular_impulse += cross(motion.position, linear) + angular;
    *velocity = after;
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
        *component(acceleration.linear, acceleration.angular, dof) = 0.0;
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
}

}  // namespace fexp::solve
