// SPDX-License-Identifier: Apache-2.0
#include "model/tie_forces.hpp"

#include <algorithm>
#include <span>

#include "model/tie_motion.hpp"

namespace fexp::model {

namespace {

/// Unit normal of the carriers' triangle, towards the node where that is off it; zero where the triangle has none.
Vec3d normal_at(const Tie& tie, const State& state) noexcept {
  const auto place = [&](std::size_t a) { return state.motion[at(tie.carrier[a])].position; };
  const Vec3d normal = cross(place(1) - place(0), place(2) - place(0));
  const double size = norm(normal);
  if (!(size > 0.0)) {
    return {};
  }
  return ((dot(arm_of(tie, state), normal) < 0.0 ? -1.0 : 1.0) / size) * normal;
}

/// Of a motion that is prescribed; where displacements are, between the points of their curve.
double told_acceleration(const Model& model, const PrescribedNode& p, double time) {
  switch (p.kind) {
    case PrescribedKind::velocity:
      return p.curve == no_index ? 0.0 : curve_slope(model, p.curve, time) * p.value;
    case PrescribedKind::acceleration:
      return curve_value(model, p.curve, time) * p.value;
    case PrescribedKind::displacement:
      break;
  }
  return 0.0;
}

/// Adds by how much the accelerations that are prescribed differ from those that forces alone would give.
void add_told(const Model& model, std::span<const PrescribedNode> prescribed, double time, double weight,
              const NodeAcceleration& by_forces, NodeAcceleration& sum) {
  for (const PrescribedNode& p : prescribed) {
    const Vec3d& present = p.angular() ? by_forces.angular : by_forces.linear;
    Vec3d& difference = p.angular() ? sum.angular : sum.linear;
    difference += (weight * (told_acceleration(model, p, time) - dot(present, p.direction))) * p.direction;
  }
}

std::span<const PrescribedNode> prescribed_at(const Model& model, Index node) {
  const auto first = std::ranges::lower_bound(model.prescribed, node, {}, &PrescribedNode::node);
  const auto last = std::ranges::upper_bound(model.prescribed, node, {}, &PrescribedNode::node);
  return std::span(model.prescribed)
      .subspan(static_cast<std::size_t>(first - model.prescribed.begin()), static_cast<std::size_t>(last - first));
}

/// Acceleration of a tied node. State::acceleration is that by forces, also where motion is prescribed.
NodeAcceleration acceleration_of(const Model& model, const State& state, double time, const Tie& tie) {
  NodeAcceleration acceleration = state.acceleration[at(tie.node)];
  NodeAcceleration told;
  Vec3d arm;
  if (tie.rigid != no_index) {
    const RigidBody& body = model.rigid_bodies[at(tie.rigid)];
    const RigidMotion& motion = state.rigid[at(tie.rigid)];
    arm = state.motion[at(tie.node)].position - motion.centre;
    add_told(model, body.prescribed, time, 1.0,
             {(1.0 / body.mass) * motion.force, state.acceleration[at(tie.carrier[0])].angular}, told);
  } else if (tie.conditions) {
    arm = arm_of(tie, state);
    for (std::size_t a = 0; a < 3; ++a) {
      add_told(model, prescribed_at(model, tie.carrier[a]), time, tie.weight[a], state.acceleration[at(tie.carrier[a])],
               told);
    }
  }
  acceleration.linear += told.linear + cross(told.angular, arm);
  acceleration.angular += told.angular;
  return acceleration;
}

}  // namespace

TieForce tie_force(const Model& model, const State& state, double time, Index number) {
  const Tie& tie = model.ties.ties[at(number)];
  const TieState& now = state.ties[at(number)];
  if (now.broken != 0) {
    return {};
  }
  const NodeAcceleration acceleration = acceleration_of(model, state, time, tie);
  TieForce result;
  result.force = now.force - model.mass[at(tie.node)] * acceleration.linear;
  if (tie.rotations) {
    result.moment = now.moment - model.inertia[at(tie.node)] * acceleration.angular;
  }
  const Vec3d normal = normal_at(tie, state);
  const double along = dot(result.force, normal);
  result.shear = norm(result.force - along * normal);
  result.normal = tie.length > 0.0 ? along : std::abs(along);
  return result;
}

bool is_beyond_strength(const Model& model, const State& state, double time, Index number) {
  const Tie& tie = model.ties.ties[at(number)];
  const TieForce force = tie_force(model, state, time, number);
  const double normal = (force.normal > 0.0 ? force.normal : 0.0) / tie.normal_strength;
  const double shear = force.shear / tie.shear_strength;
  return normal * normal + shear * shear >= 1.0;
}

TieResultant tie_resultant(const Model& model, const State& state, Index description) {
  TieResultant sum;
  Vec3d centre;
  double count = 0.0;
  const std::vector<Tie>& ties = model.ties.ties;
  for (const Tie& tie : ties) {
    if (tie.description == description) {
      centre += state.motion[at(tie.node)].position;
      count += 1.0;
    }
  }
  centre = (1.0 / count) * centre;
  for (std::size_t t = 0; t < ties.size(); ++t) {
    if (ties[t].description != description) {
      continue;
    }
    const TieForce one = tie_force(model, state, state.time, static_cast<Index>(t));
    sum.force += one.force;
    sum.moment += one.moment + cross(state.motion[at(ties[t].node)].position - centre, one.force);
    sum.normal += one.normal;
    sum.shear += one.shear;
  }
  return sum;
}

std::int64_t broken_ties(const Model& model, const State& state, Index description) {
  std::int64_t count = 0;
  for (std::size_t t = 0; t < state.ties.size(); ++t) {
    count += model.ties.ties[t].description == description ? state.ties[t].broken : 0;
  }
  return count;
}

}  // namespace fexp::model
