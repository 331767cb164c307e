// SPDX-License-Identifier: Apache-2.0
#include "solve/rest.hpp"

#include <algorithm>

#include "parallel/parallel.hpp"
#include "solve/rigid_laws.hpp"

namespace fexp::solve {

namespace {

constexpr Index rest_piece = 1024;

/// What bringing to rest takes.
struct Taken {
  double energy{};        ///< [force*length]
  Vec3d impulse;          ///< [force*time]
  Vec3d angular_impulse;  ///< About the origin [force*length*time]
};

Taken plus(Taken a, const Taken& b) noexcept {
  a.energy += b.energy;
  a.impulse += b.impulse;
  a.angular_impulse += b.angular_impulse;
  return a;
}

Taken stop_nodes(const model::Model& model, model::State& state, const FreePart& free, Index begin, Index end) {
  Taken taken;
  for (Index n = begin; n < end; ++n) {
    model::NodeMotion& motion = state.motion[at(n)];
    const double mass = moving_mass(model, state, n), inertia = moving_inertia(model, state, n);
    Vec3d v = motion.velocity, w = motion.rotation_rate;
    free.reduce(n, v, w);
    // What is prescribed is orthogonal to the rest, which therefore has an energy of its own.
    taken.energy += 0.5 * (mass * dot(v, v) + inertia * dot(w, w));
    taken.impulse -= mass * v;
    taken.angular_impulse -= cross(motion.position, mass * v) + inertia * w;
    motion.velocity -= v;
    motion.rotation_rate -= w;
  }
  return taken;
}

Taken stop_rigid(const model::Model& model, const model::RigidBody& body, double time, model::RigidMotion& motion) {
  Taken taken;
  Vec3d velocity = motion.velocity;
  for (const model::PrescribedNode& p : body.prescribed) {
    if (!p.angular()) {
      velocity -= dot(velocity, p.direction) * p.direction;
    }
  }
  const double rotation = rotation_energy(body, motion);
  const Vec3d momentum = motion.angular_momentum;
  motion.velocity -= velocity;
  motion.angular_momentum = {};
  // Of all motions with the rates that conditions ask for, that with the least energy.
  RigidBooks unused;
  hold_rotation(model, body, {HalfStep::closing, time, 0.0, 0.0}, motion, unused);
  taken.energy = 0.5 * body.mass * dot(velocity, velocity) + rotation - rotation_energy(body, motion);
  taken.impulse = -body.mass * velocity;
  taken.angular_impulse = cross(motion.centre, taken.impulse) + (motion.angular_momentum - momentum);
  return taken;
}

}  // namespace

FreePart::FreePart(const model::Model& model, Index body) : model_(model), range_(model.bodies[at(body)].prescribed) {}

void FreePart::reduce(Index node, Vec3d& linear, Vec3d& angular) const {
  const auto begin = model_.prescribed.begin() + range_.begin, end = model_.prescribed.begin() + range_.end;
  for (auto p = std::lower_bound(begin, end, node, [](const auto&a, Index n) { return a.node < n; });
       p != end && p->node == node; ++p) {
    Vec3d& part = p->dof < 3 ? linear : angular;
    part -= dot(part, p->direction) * p->direction;
  }
}

void bring_to_rest(const model::Model& model, model::State& state, Index body) {
  const model::Body& owner = model.bodies[at(body)];
  Taken taken;
  if (owner.rigid != no_index) {
    taken = stop_rigid(model, model.rigid_bodies[at(owner.rigid)], state.time, state.rigid[at(owner.rigid)]);
  } else {
    const FreePart free(model, body);
    taken = parallel::ordered_fold(
        owner.nodes, rest_piece, Taken{},
        [&](Index begin, Index end) { return stop_nodes(model, state, free, begin, end); }, plus);
  }
  model::BodyLedger& ledger = state.ledger[at(body)];
  ledger.damping_work += taken.energy;
  ledger.external_impulse += taken.impulse;
  ledger.external_angular_impulse += taken.angular_impulse;
}

}  // namespace fexp::solve
