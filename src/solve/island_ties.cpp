// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "base/pack.hpp"
#include "model/tie_motion.hpp"
#include "solve/island_step.hpp"

/// Ties in the step of an island. Forces of tied nodes go to their carriers once all that acts on nodes is there, and
/// the nodes are moved by them: velocities before the motion of a step, places after it, both again at its end.
namespace fexp::solve {

void IslandSolver::assign_ties(const model::Model& model, const model::State& state) {
  ties_.clear();
  can_break_ = false;
  for (const Index body : bodies_) {
    const model::Body& owner = model.bodies[at(body)];
    for (Index t = owner.ties.begin; t < owner.ties.end; ++t) {
      if (state.ties[at(t)].broken != 0) {
        continue;
      }
      const model::Tie& tie = model.ties.ties[at(t)];
      IslandTie& of_island = ties_.emplace_back();
      of_island.tie = t;
      of_island.body = body;
      of_island.carrier = model.node_body[at(tie.carrier[0])];
      const auto first = std::ranges::lower_bound(pieces_, tie.held ? body : of_island.carrier, {}, &Piece::body);
      of_island.piece = static_cast<std::size_t>(first - pieces_.begin());
      can_break_ = can_break_ || tie.breaks;
    }
    for (Index b = owner.tied_blocks.begin; b < owner.tied_blocks.end; ++b) {
      inertia_ratio_ = maximum(inertia_ratio_, model.ties.blocks[at(b)].ratio);
    }
  }
  held_ = held_ || !ties_.empty();
  kept_.resize(pieces_.size());
}

/// Work of a tie in half a step, by the power of its node's force on the carriers. What arms take from one body and do
/// not give to the other, as they turn in a step, is the tied body's.
void IslandSolver::book_tie(const Step& step, const IslandTie& of_island, double power) {
  step.state.tie_work[at(of_island.carrier)] += step.half_dt() * power;
  step.state.tie_work[at(of_island.body)] -= step.half_dt() * power;
}

/// Until now the acceleration of a tied node has been its force (see Workspace::inverse_inertia), unless it is fixed.
void IslandSolver::carry_ties(const Step& step) {
  for (const IslandTie& of_island : ties_) {
    const model::Tie& tie = step.model.ties.ties[at(of_island.tie)];
    model::TieState& known = step.state.ties[at(of_island.tie)];
    const model::NodeMotion& node = step.state.motion[at(tie.node)];
    model::NodeAcceleration& own = step.state.acceleration[at(tie.node)];
    if (tie.is_fixed()) {
      known.force = step.model.mass[at(tie.node)] * own.linear;
      known.moment = tie.rotations ? step.model.inertia[at(tie.node)] * own.angular : Vec3d{};
      continue;
    }
    const Vec3d force = own.linear, moment = tie.rotations ? own.angular : Vec3d{};
    known.force = force;
    known.moment = moment;
    own.linear = {};
    own.angular = tie.rotations ? Vec3d{} : own.angular;
    Partial& partial = partials_[of_island.piece];
    if (tie.held) {
      partial.force -= force;
      partial.moment -= cross(node.position, force) + moment;
      continue;
    }
    if (tie.rigid != no_index) {
      const Vec3d& centre = step.state.rigid[at(tie.rigid)].centre;
      partial.rigid_force += force;
      partial.rigid_moment += cross(node.position - centre, force) + moment;
      book_tie(step, of_island, dot(force, node.velocity) + dot(moment, node.rotation_rate));
      continue;
    }
    const Vec3d turning = cross(model::arm_of(tie, step.state), force) + moment;
    const model::TieRates rates = model::rates_at_carriers(tie, step.state);
    book_tie(step, of_island, dot(force, rates.velocity) + dot(turning, rates.rotation_rate));
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t carrier = at(tie.carrier[a]);
      const InverseInertia& inverse = step.workspace.inverse_inertia[carrier];
      step.state.acceleration[carrier].linear += (inverse.mass * tie.weight[a]) * force;
      step.state.acceleration[carrier].angular += (inverse.inertia * tie.weight[a]) * turning;
    }
  }
}

/// After the opening half step: the velocities with which tied nodes come in this step to where they belong at its end.
void IslandSolver::steer_ties(const Step& step) {
  for (IslandTie& of_island : ties_) {
    const model::Tie& tie = step.model.ties.ties[at(of_island.tie)];
    const model::TieState& known = step.state.ties[at(of_island.tie)];
    model::NodeMotion& node = step.state.motion[at(tie.node)];
    const model::TieRates rates = model::rates_at_carriers(tie, step.state);
    if (tie.held) {
      of_island.place = node.position;
      node.velocity = {};
    } else if (tie.rigid != no_index) {
      const Vec3d& reference_centre = step.model.rigid_bodies[at(tie.rigid)].centre;
      const model::RigidMotion& motion = step.state.rigid[at(tie.rigid)];
      of_island.place =
          motion.centre + rotated(motion.orientation, step.model.reference_position[at(tie.node)] - reference_centre);
      node.velocity = (1.0 / step.dt) * (of_island.place - node.position);
      book_tie(step, of_island, dot(known.force, node.velocity) + dot(known.moment, rates.rotation_rate));
    } else {
      const Vec3d before = model::arm_of(tie, step.state);
      of_island.place =
          model::turned_arm(tie, before, step.dt * rates.rotation_rate);  // The arm, until carriers are moved
      node.velocity = rates.velocity + cross(rates.rotation_rate, 0.5 * (before + of_island.place));
      const Vec3d turning = cross(before, known.force) + known.moment;
      book_tie(step, of_island, dot(known.force, rates.velocity) + dot(turning, rates.rotation_rate));
    }
    if (tie.rotations) {
      node.rotation_rate = rates.rotation_rate;
    }
  }
}

/// Places tied nodes once their carriers have moved, so that nothing drifts.
void IslandSolver::place_ties(const Step& step) {
  for (const IslandTie& of_island : ties_) {
    const model::Tie& tie = step.model.ties.ties[at(of_island.tie)];
    Vec3d place = of_island.place;
    for (std::size_t a = 0; a < 3 && tie.rigid == no_index && !tie.held; ++a) {
      place += tie.weight[a] * step.state.motion[at(tie.carrier[a])].position;
    }
    step.state.motion[at(tie.node)].position = place;
  }
}

/// Velocities and accelerations of tied nodes at the step boundary.
void IslandSolver::rate_ties(const Step& step) const {
  for (const IslandTie& of_island : ties_) {
    const model::Tie& tie = step.model.ties.ties[at(of_island.tie)];
    if (tie.is_fixed()) {
      continue;
    }
    model::rate_tied_node(tie, step.state);
    model::NodeAcceleration& own = step.state.acceleration[at(tie.node)];
    const model::TieRates rates = model::rates_at_carriers(tie, step.state);
    Vec3d linear, angular;
    for (std::size_t a = 0; a < 3 && !tie.held; ++a) {
      const model::NodeAcceleration& carrier = step.state.acceleration[at(tie.carrier[a])];
      linear += tie.weight[a] * carrier.linear;
      angular += tie.weight[a] * carrier.angular;
    }
    const Vec3d arm = model::arm_of(tie, step.state);
    own.linear = linear + cross(angular, arm) + cross(rates.rotation_rate, cross(rates.rotation_rate, arm));
    own.angular = tie.rotations ? angular : own.angular;
  }
}

}  // namespace fexp::solve
