// SPDX-License-Identifier: Apache-2.0
#include "solve/diagnostics.hpp"

#include <algorithm>
#include <functional>

#include "parallel/parallel.hpp"
#include "solve/rigid_laws.hpp"

namespace fexp::solve {

namespace {

constexpr Index piece = 1024;
/// Of a rigid body in a critical step [rad]: the splitting of its rotation stays accurate.
constexpr double largest_turn = 0.2;

Diagnostics node_sums(const model::Model& model, const model::State& state, Index begin, Index end) {
  Diagnostics sum;
  for (Index n = begin; n < end; ++n) {
    const model::NodeMotion& motion = state.motion[at(n)];
    const double mass = moving_mass(model, state, n), inertia = moving_inertia(model, state, n);
    sum.energies.kinetic += 0.5 * (mass * dot(motion.velocity, motion.velocity) +
                                   inertia * dot(motion.rotation_rate, motion.rotation_rate));
    const Vec3d linear = mass * motion.velocity;
    const Vec3d orbital = cross(motion.position, linear);
    const Vec3d spin = inertia * motion.rotation_rate;
    sum.momenta.linear += linear;
    sum.momenta.angular += orbital + spin;
    sum.momenta.linear_scale += norm(linear);
    sum.momenta.angular_scale += norm(orbital) + norm(spin);
    const model::NodeAcceleration& acceleration = state.acceleration[at(n)];
    sum.acceleration_square += mass * dot(acceleration.linear, acceleration.linear) +
                               inertia * dot(acceleration.angular, acceleration.angular);
  }
  return sum;
}

Diagnostics plus(Diagnostics a, const Diagnostics& b) noexcept { return a += b; }

Diagnostics rigid_sums(const model::RigidBody& body, const model::RigidMotion& motion) {
  Diagnostics sum;
  const Vec3d linear = body.mass * motion.velocity, orbital = cross(motion.centre, linear);
  sum.energies.kinetic = 0.5 * body.mass * dot(motion.velocity, motion.velocity) + rotation_energy(body, motion);
  sum.momenta.linear = linear;
  sum.momenta.angular = orbital + motion.angular_momentum;
  sum.momenta.linear_scale = norm(linear);
  sum.momenta.angular_scale = norm(orbital) + norm(motion.angular_momentum);
  sum.acceleration_square = dot(motion.force, motion.force) / body.mass +
                            dot(motion.moment, inverse_inertia_times(body, motion.orientation, motion.moment));
  return sum;
}

double internal_energy(const model::Model& model, const model::State& state, Index begin, Index end) {
  double sum = 0.0;
  for (Index e = begin; e < end; ++e) {
    sum += element_value(model, state, e, model::row_energy);
  }
  return sum;
}

double stiffness_damping_work(const model::Model& model, const model::State& state, Index begin, Index end) {
  double sum = 0.0;
  for (Index e = begin; e < end; ++e) {
    sum += model::damping_work(model, state, e);
  }
  return sum;
}

/// Plastic work and the number of deleted elements.
Diagnostics layer_sums(const model::Model& model, const model::State& state, Index begin, Index end) {
  Diagnostics sum;
  for (Index e = begin; e < end; ++e) {
    if (model.blocks[at(model.element_block[at(e)])].layer_row != no_index) {
      sum.energies.dissipated += model::layer_value(model, state, e, physics::layer_dissipation);
      sum.deleted += model::is_deleted(model, state.layers.data(), e) ? 1 : 0;
    }
  }
  return sum;
}

}  // namespace

Diagnostics motion_diagnostics(const model::Model& model, const model::State& state, Index body) {
  const model::Body& owner = model.bodies[at(body)];
  if (owner.rigid != no_index) {
    return rigid_sums(model.rigid_bodies[at(owner.rigid)], state.rigid[at(owner.rigid)]);
  }
  return parallel::ordered_fold(
      owner.nodes, piece, Diagnostics{}, [&](Index begin, Index end) { return node_sums(model, state, begin, end); },
      plus);
}

Energies& Energies::operator+=(const Energies& other) noexcept {
  kinetic += other.kinetic;
  internal += other.internal;
  contact += other.contact;
  barrier += other.barrier;
  external += other.external;
  damping += other.damping;
  dissipated += other.dissipated;
  friction += other.friction;
  return *this;
}

Momenta& Momenta::operator+=(const Momenta& other) noexcept {
  linear += other.linear;
  angular += other.angular;
  linear_scale += other.linear_scale;
  angular_scale += other.angular_scale;
  external_impulse += other.external_impulse;
  external_angular_impulse += other.external_angular_impulse;
  return *this;
}

Diagnostics& Diagnostics::operator+=(const Diagnostics& other) noexcept {
  energies += other.energies;
  momenta += other.momenta;
  deleted += other.deleted;
  acceleration_square += other.acceleration_square;
  return *this;
}

Diagnostics body_diagnostics(const model::Model& model, const model::State& state, Index body) {
  const model::Body& owner = model.bodies[at(body)];
  const model::BodyLedger& ledger = state.ledger[at(body)];
  Diagnostics sum = motion_diagnostics(model, state, body);
  sum.energies.internal = parallel::ordered_fold(
      owner.elements, piece, 0.0, [&](Index begin, Index end) { return internal_energy(model, state, begin, end); },
      std::plus<>());
  if (model.plastic) {
    sum += parallel::ordered_fold(
        owner.elements, piece, Diagnostics{},
        [&](Index begin, Index end) { return layer_sums(model, state, begin, end); }, plus);
  }
  sum.energies.contact = ledger.contact_energy;
  sum.energies.barrier = ledger.barrier_energy;
  sum.energies.friction = ledger.contact_dissipation + ledger.wall_dissipation;
  sum.energies.external = ledger.external_work;
  sum.energies.damping = ledger.damping_work;
  if (!state.damping.empty()) {
    sum.energies.damping += parallel::ordered_fold(
        owner.elements, piece, 0.0,
        [&](Index begin, Index end) { return stiffness_damping_work(model, state, begin, end); }, std::plus<>());
  }
  sum.momenta.external_impulse = ledger.external_impulse;
  sum.momenta.external_angular_impulse = ledger.external_angular_impulse;
  return sum;
}

Diagnostics diagnostics(const model::Model& model, const model::State& state) {
  Diagnostics sum;
  for (Index body = 0; body < model.body_count(); ++body) {
    sum += body_diagnostics(model, state, body);
  }
  return sum;
}

CriticalStep body_critical_step(const model::Model& model, const model::State& state, Index body) {
  if (const Index rigid = model.bodies[at(body)].rigid; rigid != no_index) {
    const double rate = norm(rotation_rate(model.rigid_bodies[at(rigid)], state.rigid[at(rigid)]));
    const double turn = rate > 0.0 ? largest_turn / rate : HUGE_VAL;
    return {std::min(model.first_critical_step, turn), model.bodies[at(body)].elements.begin};
  }
  const StepKernel kernel = select_element_kernel(KernelChoice::automatic).steps;
  const StepKernelArguments arguments{state.motion.data(),
                                      model.triangle.data(),
                                      model.blocks.data(),
                                      model.sections.data(),
                                      model.run.drilling,
                                      model.step_factor.empty() ? nullptr : model.step_factor.data(),
                                      state.layers.data(),
                                      model.reference_area.data(),
                                      model.run.stiffness_damping > 0.0};
  CriticalStep smallest = parallel::ordered_fold(
      model.bodies[at(body)].blocks, piece / model::block_lanes, CriticalStep{},
      [&](Index begin, Index end) { return kernel(arguments, begin, end); }, smaller);
  const IndexRange tied = model.bodies[at(body)].tied_blocks;
  for (Index t = tied.begin; t < tied.end; ++t) {
    const model::TiedBlock& block = model.ties.blocks[at(t)];
    CriticalStep critical = kernel(arguments, block.block, block.block + 1);
    critical.step /= square_root(block.ratio);
    smallest = smaller(smallest, critical);
  }
  return smallest;
}

}  // namespace fexp::solve
