// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "model/tie_forces.hpp"
#include "model/tie_motion.hpp"
#include "parallel/parallel.hpp"
#include "solve/diagnostics.hpp"
#include "solve/island_step.hpp"
#include "solve/tie_release.hpp"

/// Ties that break in the step of an island. The forces of a step's end tell which do, and the next step begins with
/// breaking them: so a state at a step boundary says by itself what comes of it, wherever it is taken up.
namespace fexp::solve {

/// What nodes have to be accelerated by. Only bodies that come from elsewhere, and ties that have just broken, change
/// it. Of a body whose ties are all broken those who carried it may be in another island: it is looked up node by node.
void IslandSolver::take_up_masses(const Step& step) const {
  if (!step.model.ties.can_break) {
    return;
  }
  for (const Index body : bodies_) {
    const IndexRange nodes = step.model.bodies[at(body)].nodes;
    for (Index n = nodes.begin; n < nodes.end; ++n) {
      const model::NodeInertia& moving = step.state.moving[at(n)];
      step.workspace.inverse_inertia[at(n)] = {1.0 / moving.mass, 1.0 / moving.inertia};
    }
  }
  for (const IslandTie& of_island : ties_) {
    const model::Tie& tie = step.model.ties.ties[at(of_island.tie)];
    if (!tie.is_fixed()) {
      step.workspace.carry(tie);
    }
  }
}

/// What central differences keep of the motion of a piece, the kinetic energy less dt^2 a.M a/8; of a rigid body it
/// counts with the first piece.
double IslandSolver::kept_energy(const Step& step, std::size_t piece) const {
  const Piece& own = pieces_[piece];
  const double factor = 0.25 * step.dt * step.dt;
  if (is_rigid(step, piece)) {
    const bool first = piece == 0 || pieces_[piece - 1].body != own.body;
    const Diagnostics sums = first ? motion_diagnostics(step.model, step.state, own.body) : Diagnostics{};
    return sums.energies.kinetic - 0.5 * factor * sums.acceleration_square;
  }
  double sum = 0.0;
  for (Index i = own.nodes.begin; i < own.nodes.end; ++i) {
    const Index n = own.node[i];
    const model::NodeMotion& motion = step.state.motion[at(n)];
    const model::NodeAcceleration& acceleration = step.state.acceleration[at(n)];
    const model::NodeInertia& moving = step.state.moving[at(n)];
    sum += 0.5 * moving.mass *
           (dot(motion.velocity, motion.velocity) - factor * dot(acceleration.linear, acceleration.linear));
    sum += 0.5 * moving.inertia *
           (dot(motion.rotation_rate, motion.rotation_rate) - factor * dot(acceleration.angular, acceleration.angular));
  }
  return sum;
}

/// The forces are evaluated anew with the masses and the contact that are left. What that changes of the energy which
/// central differences keep is booked: of the bodies on the work of ties, of all together on the external work of the
/// first tied body.
void IslandSolver::break_ties(const Step& step, double start_time) {
  const auto is_due = [&](const IslandTie& of_island) {
    return step.model.ties.ties[at(of_island.tie)].breaks &&
           model::is_beyond_strength(step.model, step.state, start_time, of_island.tie);
  };
  const auto due = std::ranges::find_if(ties_, is_due);
  if (due == ties_.end()) {
    return;
  }
  const Index first = due->body;
  const auto for_each_piece = [&](const auto& visit) {
    parallel::for_each(static_cast<Index>(pieces_.size()), grain(pieces_.size(), nodes_, task_nodes), visit);
  };
  for_each_piece([&](Index i) { kept_[at(i)] = kept_energy(step, at(i)); });
  // Those that are due first of all: with the first release velocities change.
  for (const IslandTie& of_island : ties_) {
    if (is_due(of_island)) {
      step.state.ties[at(of_island.tie)] = {{}, {}, 1};
    }
  }
  const auto is_broken = [&](const IslandTie& of_island) { return step.state.ties[at(of_island.tie)].broken != 0; };
  for (const IslandTie& of_island : ties_) {
    if (is_broken(of_island)) {
      const Release release = release_tied_node(step.model, step.model.ties.ties[at(of_island.tie)], step.state);
      model::BodyLedger& ledger = step.state.ledger[at(of_island.body)];
      ledger.external_impulse += release.impulse;
      ledger.external_angular_impulse += release.angular_impulse;
    }
  }
  // The sums of those that are left, as if there had never been others.
  for (const IslandTie& of_island : ties_) {
    model::for_each_handed(step.model, step.model.ties.ties[at(of_island.tie)], [&](Index carrier, double, double) {
      step.state.moving[at(carrier)] = {step.model.mass[at(carrier)], step.model.inertia[at(carrier)]};
    });
  }
  std::erase_if(ties_, is_broken);
  for (const IslandTie& of_island : ties_) {
    model::for_each_handed(step.model, step.model.ties.ties[at(of_island.tie)],
                           [&](Index carrier, double mass, double inertia) {
                             step.state.moving[at(carrier)].mass += mass;
                             step.state.moving[at(carrier)].inertia += inertia;
                           });
  }
  evaluate(Step{step.model, step.state, step.workspace, 0.0, start_time, 0.0});
  for_each_piece([&](Index i) { kept_[at(i)] = kept_energy(step, at(i)) - kept_[at(i)]; });
  double sum = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    step.state.tie_work[at(pieces_[i].body)] += kept_[i];
    sum += kept_[i];
  }
  step.state.tie_work[at(first)] -= sum;
  step.state.ledger[at(first)].external_work += sum;
}

}  // namespace fexp::solve
