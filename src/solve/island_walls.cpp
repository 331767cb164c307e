// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "base/pack.hpp"
#include "solve/island_step.hpp"
#include "solve/walls.hpp"

/// Motion of rigid walls in an island's step. A wall with mass is a body of the island, whose node is moved as others
/// are, but accelerated after them by what they push it with.
namespace fexp::solve {

namespace {

Index node_of(const model::Model& model, Index wall) {
  return model.bodies[at(model.walls[at(wall)].body)].nodes.begin;
}

}  // namespace

/// Where walls that move as told are at the end of the step, and how far they come in it; where the others are.
void IslandSolver::move_walls(const Step& step) {
  for (const Index w : walls_) {
    const model::Wall& wall = step.model.walls[at(w)];
    if (wall.body != no_index) {
      wall_points_[at(w)] = step.state.motion[at(node_of(step.model, w))].position;
      wall_ways_[at(w)] = {};
      continue;
    }
    wall_points_[at(w)] = wall_point(step.model, wall, step.end_time);
    wall_ways_[at(w)] = wall_points_[at(w)] - wall_point(step.model, wall, step.end_time - step.dt);
  }
}

/// Once all nodes have moved: where walls with mass have come, and their work with the forces of the step's start.
void IslandSolver::follow_walls(const Step& step) {
  for (const Index w : own_walls_) {
    const model::NodeMotion& motion = step.state.motion[at(node_of(step.model, w))];
    wall_points_[at(w)] = motion.position;
    wall_ways_[at(w)] = step.dt * motion.velocity;
    for (const Index body : bodies_) {
      const Vec3d& force = step.workspace.actions[at(body)].wall_force[at(w)];
      step.state.ledger[at(body)].external_work += 0.5 * dot(force, wall_ways_[at(w)]);
    }
  }
}

/// Work that the walls do on a body with the forces of one end of the step.
double IslandSolver::half_work_of_walls(const BodyActions& actions) const {
  double work = 0.0;
  for (const Index w : walls_) {
    work += 0.5 * dot(actions.wall_force[at(w)], wall_ways_[at(w)]);
  }
  return work;
}

/// Acceleration of a wall with mass by all bodies of the island, and its books. As the force of the wall on its own
/// body counts what the others push it with, so that its work is that on them with the sign turned.
void IslandSolver::push_wall(const Step& step, Index body, std::size_t piece) {
  const model::Model& model = step.model;
  const Index wall = model.bodies[at(body)].wall, node = node_of(model, wall);
  const model::NodeMotion& motion = step.state.motion[at(node)];
  BodyActions& actions = step.workspace.actions[at(body)];
  Vec3d push;
  for (const Index other : bodies_) {
    push -= other == body ? Vec3d{} : step.workspace.actions[at(other)].wall_force[at(wall)];
  }
  actions.wall_force[at(wall)] = push;
  Vec3d force = push;
  if (!step.workspace.load.empty()) {
    const Vec3d& load = step.workspace.load[at(node)].force;
    force += load;
    partials_[piece].external_work += step.half_dt() * dot(load, motion.velocity);
  }
  actions.force = force;
  actions.moment = cross(motion.position, force);
  step.state.acceleration[at(node)] = {model.walls[at(wall)].inverse_mass * force, {}};
  hold_constraints(model, step.state, body, actions);
}

/// Nodes on a wall with mass swing against it together: the bound of omega^2 grows by the worst of these walls.
void IslandSolver::join_by_walls(const Step& step) {
  const std::size_t walls = step.model.walls.size();
  const double nodes2 = barrier_frequency2_;
  for (const Index w : own_walls_) {
    WallTouch sum;
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      sum.stiffness += touches_[piece * walls + at(w)].stiffness;
      sum.damping += touches_[piece * walls + at(w)].damping;
    }
    const double frequency2 = joined_frequency2(nodes2, sum, step.model.walls[at(w)].inverse_mass);
    if (frequency2 > barrier_frequency2_) {
      barrier_frequency2_ = frequency2;
      // Where the wall's mass has less than half of it, the wall of the worst node is to be named.
      barrier_wall_ = frequency2 > 2.0 * nodes2 ? w : barrier_wall_;
    }
  }
}

}  // namespace fexp::solve
