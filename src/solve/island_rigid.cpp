// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "parallel/parallel.hpp"
#include "solve/island_step.hpp"
#include "solve/rigid_laws.hpp"

/// Passes of an island's step over its rigid bodies: forces are summed over pieces of their nodes, the bodies move, and
/// their nodes are placed again.
namespace fexp::solve {

namespace {

void book(const RigidBooks& books, model::BodyLedger& ledger) {
  ledger.external_work += books.work;
  ledger.damping_work += books.damping_work;
  ledger.external_impulse += books.impulse;
  ledger.external_angular_impulse += books.angular_impulse;
}

bool is_finite(const model::RigidMotion& motion) noexcept {
  const double squares = dot(motion.velocity, motion.velocity) + dot(motion.angular_momentum, motion.angular_momentum);
  return squares - squares == 0.0;
}

}  // namespace

template <class Visit>
void IslandSolver::for_each_rigid(const Visit& visit) {
  parallel::for_each(static_cast<Index>(rigid_.size()), body_grain, [&](Index i) { visit(rigid_[at(i)]); });
}

template <class Visit>
void IslandSolver::for_each_rigid_piece(const Visit& visit) {
  parallel::for_each(static_cast<Index>(rigid_pieces_.size()), grain(rigid_pieces_.size(), rigid_nodes_, task_nodes),
                     [&](Index i) { visit(at(rigid_pieces_[at(i)])); });
}

/// Forces on the nodes of a piece, and their moment about the body's centre.
void IslandSolver::sum_rigid_piece(const Step& step, std::size_t index) {
  const Piece& piece = pieces_[index];
  Partial& partial = partials_[index];
  const model::RigidMotion& motion = step.state.rigid[at(step.model.bodies[at(piece.body)].rigid)];
  clear_actions(step, index);
  partial.rigid_force = {};
  partial.rigid_moment = {};
  for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
    const Index n = piece.node[i];
    NodalAction action = step.workspace.external ? act_on_node(step, n, index) : NodalAction{};
    if (contact_written_) {
      action.force += step.workspace.contact.force[at(n)];
    }
    partial.rigid_force += action.force;
    partial.rigid_moment += cross(step.state.motion[at(n)].position - motion.centre, action.force) + action.moment;
  }
}

void IslandSolver::sum_rigid_pieces(const Step& step) {
  for_each_rigid_piece([&](std::size_t index) { sum_rigid_piece(step, index); });
}

/// The bodies' sums, in order, less what holds the centre.
void IslandSolver::accelerate_rigid(const Step& step) {
  for_each_rigid([&](const RigidPart& part) {
    const model::RigidBody& body = step.model.rigid_bodies[at(part.rigid)];
    model::RigidMotion& motion = step.state.rigid[at(part.rigid)];
    Vec3d force;
    motion.moment = {};
    for (Index p = part.pieces.begin; p < part.pieces.end; ++p) {
      force += partials_[at(p)].rigid_force;
      motion.moment += partials_[at(p)].rigid_moment;
    }
    motion.force = model::without(body.held, force);
    if (!body.held.empty()) {
      BodyActions& actions = step.workspace.actions[at(body.body)];
      const Vec3d reaction = motion.force - force;
      actions.force += reaction;
      actions.moment += cross(motion.centre, reaction);
    }
  });
}

/// Velocities and accelerations of the nodes at the step boundary.
void IslandSolver::rate_rigid_nodes(const Step& step) {
  for_each_rigid_piece([&](std::size_t index) {
    const Piece& piece = pieces_[index];
    const Index number = step.model.bodies[at(piece.body)].rigid;
    const model::RigidBody& body = step.model.rigid_bodies[at(number)];
    const model::RigidMotion& motion = step.state.rigid[at(number)];
    const Vec3d rate = rotation_rate(body, motion);
    const Vec3d angular = angular_acceleration(body, motion, rate);
    const Vec3d linear = (1.0 / body.mass) * motion.force;
    for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
      const Index n = piece.node[i];
      model::NodeMotion& node = step.state.motion[at(n)];
      const Vec3d arm = node.position - motion.centre;
      node.velocity = velocity_at(motion, rate, node.position);
      node.rotation_rate = rate;
      step.state.acceleration[at(n)] = {linear + cross(angular, arm) + cross(rate, cross(rate, arm)), angular};
    }
  });
}

/// Half a step of velocities and a step of positions. Inside the step the velocity of a node is that of its chord,
/// which is how contact learns where it came from.
void IslandSolver::open_rigid(const Step& step) {
  if (rigid_.empty()) {
    return;
  }
  for_each_rigid([&](RigidPart& part) {
    const model::RigidBody& body = step.model.rigid_bodies[at(part.rigid)];
    model::RigidMotion& motion = step.state.rigid[at(part.rigid)];
    const RigidHalf half{HalfStep::opening, step.middle_time(), step.half_dt(), step.damping};
    RigidBooks books;
    const double before = body.prescribes_rotation ? rotation_energy(body, motion) : 0.0;
    kick_rigid(step.model, body, half, motion, books);
    part.rotation_rate = drift(step.model, body, half, motion, books);
    if (body.prescribes_rotation) {
      books.work += books.rotation_damping - before - step.half_dt() * dot(motion.moment, part.rotation_rate);
    }
    book(books, step.state.ledger[at(body.body)]);
    for (Index p = part.pieces.begin; p < part.pieces.end; ++p) {
      Partial& partial = partials_[at(p)];
      const bool closing_finite = partial.closing_finite;
      partial = {};
      partial.closing_finite = closing_finite;
      partial.rotation_rate = part.rotation_rate;
    }
  });
  for_each_rigid_piece([&](std::size_t index) { place_rigid_nodes(step, index); });
}

void IslandSolver::place_rigid_nodes(const Step& step, std::size_t index) {
  const Piece& piece = pieces_[index];
  Partial& partial = partials_[index];
  const Index number = step.model.bodies[at(piece.body)].rigid;
  const Vec3d& reference_centre = step.model.rigid_bodies[at(number)].centre;
  const model::RigidMotion& motion = step.state.rigid[at(number)];
  const double per_step = 1.0 / step.dt;
  const bool loaded = !step.workspace.load.empty();
  double largest = 0.0;
  for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
    const Index n = piece.node[i];
    model::NodeMotion& node = step.state.motion[at(n)];
    const Vec3d position =
        motion.centre + rotated(motion.orientation, step.model.reference_position[at(n)] - reference_centre);
    node.velocity = per_step * (position - node.position);
    node.rotation_rate = partial.rotation_rate;
    node.position = position;
    if (loaded) {
      const NodalAction& load = step.workspace.load[at(n)];
      partial.external_work += step.half_dt() * (dot(load.force, node.velocity) + dot(load.moment, node.rotation_rate));
    }
    const double speed2 = dot(node.velocity, node.velocity);
    largest = speed2 > largest ? speed2 : largest;
  }
  partial.largest_speed2 = largest;
  const double squares = largest + dot(partial.rotation_rate, partial.rotation_rate);
  partial.finite = squares - squares == 0.0 && is_finite(motion);
}

/// The closing half step of the bodies.
void IslandSolver::close_rigid(const Step& step) {
  for_each_rigid([&](RigidPart& part) {
    const model::RigidBody& body = step.model.rigid_bodies[at(part.rigid)];
    model::RigidMotion& motion = step.state.rigid[at(part.rigid)];
    const RigidHalf half{HalfStep::closing, step.end_time, step.half_dt(), step.damping};
    RigidBooks books;
    if (body.prescribes_rotation) {
      books.work -= step.half_dt() * dot(motion.moment, part.rotation_rate);
    }
    kick_rigid(step.model, body, half, motion, books);
    if (!body.turns_freely) {
      hold_rotation(step.model, body, half, motion, books);
    }
    if (body.prescribes_rotation) {
      books.work += books.rotation_damping + rotation_energy(body, motion);
    }
    book(books, step.state.ledger[at(body.body)]);
    for (Index p = part.pieces.begin; p < part.pieces.end; ++p) {
      partials_[at(p)].closing_finite = is_finite(motion);
    }
  });
}

/// What follows the forces of a step: the closing half step, and then either the state at the end of the step or, where
/// the next one follows at once, its opening half and motion.
void IslandSolver::finish_rigid(const Step& step, bool go_on) {
  if (rigid_.empty()) {
    return;
  }
  close_rigid(step);
  if (go_on) {
    open_rigid(step);
  } else {
    rate_rigid_nodes(step);
  }
}

}  // namespace fexp::solve
