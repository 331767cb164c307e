// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "base/pack.hpp"
#include "parallel/parallel.hpp"
#include "solve/island_step.hpp"
#include "solve/loads.hpp"
#include "solve/walls.hpp"

/// What acts on an island's bodies besides each other: loads, rigid walls and conditions, with the bodies' books.
namespace fexp::solve {

void IslandSolver::load_nodes(const Step& step) {
  parallel::for_each(static_cast<Index>(bodies_.size()), body_grain, [&](Index i) {
    evaluate_loads(step.model, step.state.motion.data(), step.state.layers.data(), step.dt == 0.0, step.end_time,
                   bodies_[at(i)], step.workspace.load.data());
  });
}

void IslandSolver::clear_actions(const Step& step, std::size_t index) {
  Partial& partial = partials_[index];
  partial.force = {};
  partial.moment = {};
  partial.barrier_energy = 0.0;
  partial.wall_dissipation = 0.0;
  partial.barrier_frequency2 = 0.0;
  const std::size_t walls = step.model.walls.size();
  std::fill_n(wall_partials_.begin() + static_cast<std::ptrdiff_t>(index * walls), walls, Vec3d{});
  for (const Index w : own_walls_) {
    touches_[index * walls + at(w)] = {};
  }
}

/// What acts on a node of a piece from outside, booked in the piece's partial sums.
NodalAction IslandSolver::act_on_node(const Step& step, Index n, std::size_t index) {
  const model::Model& model = step.model;
  const model::NodeMotion& motion = step.state.motion[at(n)];
  const std::size_t walls = model.walls.size();
  Partial& partial = partials_[index];
  NodalAction outside;
  if (!step.workspace.load.empty()) {
    outside = step.workspace.load[at(n)];
    partial.external_work +=
        step.half_dt() * (dot(outside.force, motion.velocity) + dot(outside.moment, motion.rotation_rate));
  }
  double stiffness = 0.0, stiffest = 0.0;
  Index stiffest_wall = no_index;
  for (const Index w : walls_) {
    const model::Wall& wall = model.walls[at(w)];
    WallReaction reaction = wall_reaction(model, wall, wall_points_[at(w)], n, motion.position);
    if (wall.rubbing != no_index) {
      // Inside a step the velocity is that of the node's way.
      const WallSlip slip{step.dt * motion.velocity - wall_ways_[at(w)], step.dt};
      Vec3d& drag = step.state.wall_drag[at(n) * at(model.rubbing_walls) + at(wall.rubbing)];
      partial.wall_dissipation += rub(model, wall, slip, n, reaction, drag);
    }
    outside.force += reaction.force;
    partial.barrier_energy += reaction.energy;
    wall_partials_[index * walls + at(w)] += reaction.force;
    if (reaction.stiffness > 0.0) {
      stiffness += reaction.stiffness;
      stiffest_wall = reaction.stiffness > stiffest ? w : stiffest_wall;
      stiffest = maximum(stiffest, reaction.stiffness);
      if (wall.inverse_mass > 0.0) {
        touches_[index * walls + at(w)].stiffness += reaction.stiffness;
        touches_[index * walls + at(w)].damping += reaction.damping;
      }
    }
  }
  if (const double frequency2 = stiffness / model.mass[at(n)]; frequency2 > partial.barrier_frequency2) {
    partial.barrier_frequency2 = frequency2;
    partial.barrier_node = n;
    partial.barrier_wall = stiffest_wall;
  }
  partial.force += outside.force;
  partial.moment += cross(motion.position, outside.force) + outside.moment;
  return outside;
}

/// Accelerations of a piece's nodes and what acts on them from outside. The slow twin of the node kernels.
void IslandSolver::accelerate(const Step& step, const NodeKernelArguments& k, std::size_t index) {
  const Piece& piece = pieces_[index];
  clear_actions(step, index);
  for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
    const Index n = piece.node[i];
    Vec3d internal, internal_moment;
    const Index force_end = k.force_start == nullptr ? i - piece.nodes.begin + 1 : k.force_start[i + 1];
    for (Index f = k.force_start == nullptr ? i - piece.nodes.begin : k.force_start[i]; f < force_end; ++f) {
      internal += k.force[f].force;
      internal_moment += k.force[f].moment;
    }
    Vec3d force = (k.contact_force != nullptr ? k.contact_force[n] : Vec3d{}) - internal;
    Vec3d moment = Vec3d{} - internal_moment;
    if (step.workspace.external) {
      const NodalAction outside = act_on_node(step, n, index);
      force += outside.force;
      moment += outside.moment;
    }
    const InverseInertia& inverse = k.inverse_inertia[n];
    step.state.acceleration[at(n)] = {inverse.mass * force, inverse.inertia * moment};
  }
}

/// Sums of what acts on every body from outside, and held components.
void IslandSolver::act_on_bodies(const Step& step) {
  Workspace& workspace = step.workspace;
  if (!workspace.external) {
    return;
  }
  const std::size_t walls = step.model.walls.size();
  barrier_frequency2_ = 0.0;
  barrier_node_ = barrier_wall_ = no_index;
  std::size_t piece = 0;
  for (const Index body : bodies_) {
    BodyActions& actions = workspace.actions[at(body)];
    actions.force = workspace.body_contact[at(body)].barrier_force;
    actions.moment = workspace.body_contact[at(body)].barrier_moment;
    std::fill(actions.wall_force.begin(), actions.wall_force.end(), Vec3d{});
    if (step.model.bodies[at(body)].wall != no_index) {
      push_wall(step, body, piece++);
      continue;
    }
    double barrier_energy = 0.0, dissipation = 0.0;
    for (; piece < pieces_.size() && pieces_[piece].body == body; ++piece) {
      actions.force += partials_[piece].force;
      actions.moment += partials_[piece].moment;
      barrier_energy += partials_[piece].barrier_energy;
      dissipation += partials_[piece].wall_dissipation;
      if (partials_[piece].barrier_frequency2 > barrier_frequency2_) {
        barrier_frequency2_ = partials_[piece].barrier_frequency2;
        barrier_node_ = partials_[piece].barrier_node;
        barrier_wall_ = partials_[piece].barrier_wall;
      }
      for (std::size_t w = 0; w < walls; ++w) {
        actions.wall_force[w] += wall_partials_[piece * walls + w];
      }
    }
    step.state.ledger[at(body)].barrier_energy = barrier_energy;
    step.state.ledger[at(body)].wall_dissipation += dissipation;
    hold_constraints(step.model, step.state, body, actions);
  }
  join_by_walls(step);
}

/// What follows the closing half steps of all pieces: prescribed velocities, and the bodies' books.
void IslandSolver::book_closing_half(const Step& step) {
  prescribe(step, HalfStep::closing);
  const double half = step.half_dt();
  std::size_t piece = 0;
  for (const Index body : bodies_) {
    const BodyActions& actions = step.workspace.actions[at(body)];
    model::BodyLedger& ledger = step.state.ledger[at(body)];
    ledger.external_work += half_work_of_walls(actions);
    ledger.external_impulse += half * actions.force;
    ledger.external_angular_impulse += half * actions.moment;
    for (; piece < pieces_.size() && pieces_[piece].body == body; ++piece) {
      const Partial& partial = partials_[piece];
      ledger.external_work += partial.external_work;
      ledger.damping_work += partial.damping_work;
      ledger.external_impulse += partial.impulse;
      ledger.external_angular_impulse += partial.angular_impulse;
    }
  }
}

}  // namespace fexp::solve
