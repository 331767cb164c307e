// SPDX-License-Identifier: Apache-2.0
#include "solve/island_solver.hpp"

#include <algorithm>

#include "base/pack.hpp"
#include "parallel/parallel.hpp"
#include "solve/loads.hpp"

namespace fexp::solve {

namespace {

/// Nodes of one chunk: small enough to balance, large enough that a chunk is worth a task.
constexpr Index chunk_nodes = 256;
/// Chunks and element blocks per task.
constexpr Index chunk_grain = 2;
constexpr Index block_grain = 32;
constexpr Index body_grain = 8;

}  // namespace

struct IslandSolver::Step {
  const model::Model& model;
  model::State& state;
  Workspace& workspace;
  double dt;        ///< [time]; 0: evaluate without moving
  double end_time;  ///< t(n+1) [time]

  [[nodiscard]] double half_dt() const noexcept { return 0.5 * dt; }
  [[nodiscard]] double middle_time() const noexcept { return end_time - 0.5 * dt; }
};

void IslandSolver::assign(const model::Model& model, const model::State& state, std::span<const Index> bodies,
                          std::span<const Index> barriers) {
  bodies_.assign(bodies.begin(), bodies.end());
  barriers_.assign(barriers.begin(), barriers.end());
  chunks_.clear();
  elements_ = 0;
  for (const Index index : bodies_) {
    const model::Body& body = model.bodies[at(index)];
    elements_ += body.elements.size();
    for (Index begin = body.nodes.begin; begin < body.nodes.end; begin += chunk_nodes) {
      chunks_.push_back({index, begin, std::min(begin + chunk_nodes, body.nodes.end)});
    }
  }
  partials_.resize(chunks_.size());
  plane_partials_.resize(chunks_.size() * model.planes.size());
  travelled_.resize(bodies_.size());
  contact_.assign(model, bodies_, barriers_, state);
  contact_report_ = {};
  contact_written_ = true;
}

void IslandSolver::evaluate(const model::Model& model, model::State& state, Workspace& workspace) {
  const Step still{model, state, workspace, 0.0, state.time};
  for (Partial& partial : partials_) {
    partial = {};
  }
  contact_forces(still);
  element_forces(still);
  accelerate(still);
}

IslandReport IslandSolver::advance(const model::Model& model, model::State& state, Workspace& workspace,
                                   const EpochPlan& plan, std::vector<HashRecord>& hashes) {
  IslandReport total;
  std::fill(travelled_.begin(), travelled_.end(), 0.0);
  const double start_time = state.time;
  const Index searches_before = contact_report_.searches;
  for (Index i = 0; i < plan.steps; ++i) {
    // The last step ends at the very time of the state after it, so that loads evaluated anew there are the same.
    const double end_time = i + 1 == plan.steps ? plan.end_time : start_time + static_cast<double>(i + 1) * plan.dt;
    const Step step{model, state, workspace, plan.dt, end_time};
    opening_half(step);
    if (!check_finite(step, total) || !check_motion(step, plan, total)) {
      return total;
    }
    contact_forces(step);
    element_forces(step);
    accelerate(step);
    closing_half(step);
    if (!check_finite(step, total)) {
      return total;
    }

    total.steps_done = i + 1;
    total.active_pairs = contact_report_.active_pairs;
    total.most_active_pairs = std::max(total.most_active_pairs, contact_report_.active_pairs);
    total.contact_frequency2 =
        std::max(total.contact_frequency2, contact_report_.max_stiffness_over_mass + barrier_frequency2_);
    total.candidates = contact_report_.candidates;
    total.searches = contact_report_.searches - searches_before;
    if (contact_report_.deepest > total.deepest) {
      total.deepest = contact_report_.deepest;
      total.deepest_node = contact_report_.deepest_node;
      total.deepest_element = contact_report_.deepest_element;
    }
    if (plan.hash_every > 0 && (state.step + i + 1) % plan.hash_every == 0) {
      record_hashes(step, state.step + i + 1, hashes);
    }
  }
  return total;
}

/// One half step of velocities, v += dt/2 a. Mass-proportional damping scales them afterwards, so that it needs no
/// memory of its force and its work is exactly the kinetic energy it takes.
void IslandSolver::kick(const Step& step, const Chunk& chunk, Partial& partial) const {
  const double half = step.half_dt();
  const double damping = step.model.run.damping;
  const double kept = 1.0 / (1.0 + damping * half);
  for (Index n = chunk.begin; n < chunk.end; ++n) {
    model::NodeMotion& motion = step.state.motion[at(n)];
    const model::NodeAcceleration& acceleration = step.state.acceleration[at(n)];
    Vec3d v = motion.velocity + half * acceleration.linear;
    Vec3d w = motion.rotation_rate + half * acceleration.angular;
    if (damping > 0.0) {
      const double mass = step.model.mass[at(n)], inertia = step.model.inertia[at(n)];
      const Vec3d lost = (mass * (kept - 1.0)) * v;
      partial.impulse += lost;
      partial.angular_impulse += cross(motion.position, lost) + (inertia * (kept - 1.0)) * w;
      partial.damping_work += 0.5 * (1.0 - kept * kept) * (mass * dot(v, v) + inertia * dot(w, w));
      v = kept * v;
      w = kept * w;
    }
    motion.velocity = v;
    motion.rotation_rate = w;
    const double squares = dot(v, v) + dot(w, w);
    partial.finite = partial.finite && squares - squares == 0.0;
  }
}

void IslandSolver::opening_half(const Step& step) {
  const double half = step.half_dt();
  const bool external = step.workspace.external;
  if (external) {
    for (const Index body : bodies_) {
      const BodyActions& actions = step.workspace.actions[at(body)];
      model::BodyLedger& ledger = step.state.ledger[at(body)];
      ledger.external_impulse += half * actions.force;
      ledger.external_angular_impulse += half * actions.moment;
    }
  }
  const auto count = static_cast<Index>(chunks_.size());
  parallel::for_each(count, chunk_grain, [&](Index i) {
    partials_[at(i)] = {};
    kick(step, chunks_[at(i)], partials_[at(i)]);
  });
  prescribe(step, HalfStep::opening);
  parallel::for_each(count, chunk_grain, [&](Index i) {
    const Chunk& chunk = chunks_[at(i)];
    Partial& partial = partials_[at(i)];
    double largest = 0.0;
    for (Index n = chunk.begin; n < chunk.end; ++n) {
      model::NodeMotion& motion = step.state.motion[at(n)];
      if (!step.workspace.load.empty()) {
        const NodalAction& load = step.workspace.load[at(n)];
        partial.external_work += half * (dot(load.force, motion.velocity) + dot(load.moment, motion.rotation_rate));
      }
      motion.position += step.dt * motion.velocity;
      const double speed2 = dot(motion.velocity, motion.velocity);
      largest = speed2 > largest ? speed2 : largest;
    }
    partial.largest_speed2 = largest;
  });
}

void IslandSolver::prescribe(const Step& step, HalfStep half) {
  if (step.model.prescribed.empty()) {
    return;
  }
  const double time = half == HalfStep::opening ? step.middle_time() : step.end_time;
  for (const Index body : bodies_) {
    const PrescribedReport report = prescribe_velocities(step.model, step.state, body, half, time, step.half_dt());
    model::BodyLedger& ledger = step.state.ledger[at(body)];
    ledger.external_work += report.work;
    ledger.external_impulse += report.impulse;
    ledger.external_angular_impulse += report.angular_impulse;
  }
}

/// False, with the lowest node concerned, when a velocity is not finite. A sum that overflows counts as well.
bool IslandSolver::check_finite(const Step& step, IslandReport& report) const {
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    if (partials_[c].finite) {
      continue;
    }
    const auto is_sound = [&](Index n) {
      const model::NodeMotion& motion = step.state.motion[at(n)];
      const double squares = dot(motion.velocity, motion.velocity) + dot(motion.rotation_rate, motion.rotation_rate);
      return squares - squares == 0.0;
    };
    report.stop = StopReason::not_finite;
    report.stop_body = chunks_[c].body;
    report.stop_node = chunks_[c].begin;
    while (report.stop_node + 1 < chunks_[c].end && is_sound(report.stop_node)) {
      ++report.stop_node;
    }
    return false;
  }
  return true;
}

/// False when a body may have left its swept box; otherwise tells contact how far nodes have moved.
bool IslandSolver::check_motion(const Step& step, const EpochPlan& plan, IslandReport& report) {
  double largest = 0.0;
  std::size_t chunk = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    double speed2 = 0.0;
    for (; chunk < chunks_.size() && chunks_[chunk].body == bodies_[b]; ++chunk) {
      speed2 = std::max(speed2, partials_[chunk].largest_speed2);
    }
    const double way = square_root(speed2) * step.dt;
    largest = std::max(largest, way);
    travelled_[b] += way;
    if (travelled_[b] > plan.allowance[at(bodies_[b])]) {
      report.stop = StopReason::left_swept_box;
      report.stop_body = bodies_[b];
      return false;
    }
  }
  contact_.advance(step.model, step.state.motion.data(), largest);
  return true;
}

void IslandSolver::contact_forces(const Step& step) {
  // Forces of the step before are wiped only when there were any: most islands do not touch most of the time.
  if (contact_written_) {
    for (const Index index : bodies_) {
      const IndexRange nodes = step.model.bodies[at(index)].nodes;
      contact::NodeContact& contact = step.workspace.contact;
      std::fill(contact.force.begin() + nodes.begin, contact.force.begin() + nodes.end, Vec3d{});
      std::fill(contact.stiffness.begin() + nodes.begin, contact.stiffness.begin() + nodes.end, 0.0);
    }
  }
  for (const Index index : bodies_) {
    step.workspace.body_contact[at(index)] = {};
  }
  contact_report_ = contact_.evaluate(step.model, step.state.motion.data(), step.dt, step.workspace.contact,
                                      step.workspace.body_contact.data());
  contact_written_ = contact_report_.active_pairs > 0;
  for (const Index index : bodies_) {
    step.state.ledger[at(index)].contact_energy = step.workspace.body_contact[at(index)].energy;
  }
}

void IslandSolver::element_forces(const Step& step) {
  const ElementKernelArguments arguments{step.state.motion.data(),
                                         step.model.triangle.data(),
                                         step.model.blocks.data(),
                                         step.workspace.sections.data(),
                                         step.state.history.data(),
                                         step.workspace.corner_force.data(),
                                         step.dt};
  const ElementKernel kernel = step.workspace.kernel.function;
  const auto update_body = [&](Index i) {
    const IndexRange blocks = step.model.bodies[at(bodies_[at(i)])].blocks;
    parallel::for_ranges(blocks.size(), block_grain,
                         [&](Index begin, Index end) { kernel(arguments, blocks.begin + begin, blocks.begin + end); });
  };
  parallel::for_each(static_cast<Index>(bodies_.size()), body_grain, update_body);
}

void IslandSolver::accelerate(const Step& step) {
  Workspace& workspace = step.workspace;
  const auto body_count = static_cast<Index>(bodies_.size());
  if (!workspace.load.empty()) {
    parallel::for_each(body_count, body_grain, [&](Index i) {
      evaluate_loads(step.model, step.state.motion.data(), step.end_time, bodies_[at(i)], workspace.load.data());
    });
  }
  parallel::for_each(static_cast<Index>(chunks_.size()), chunk_grain, [&](Index i) { accelerate_chunk(step, at(i)); });
  if (!workspace.external) {
    return;
  }
  const std::size_t planes = step.model.planes.size();
  barrier_frequency2_ = 0.0;
  std::size_t chunk = 0;
  for (const Index body : bodies_) {
    BodyActions& actions = workspace.actions[at(body)];
    actions.force = workspace.body_contact[at(body)].barrier_force;
    actions.moment = workspace.body_contact[at(body)].barrier_moment;
    std::fill(actions.plane_force.begin(), actions.plane_force.end(), Vec3d{});
    double barrier_energy = 0.0;
    for (; chunk < chunks_.size() && chunks_[chunk].body == body; ++chunk) {
      actions.force += partials_[chunk].force;
      actions.moment += partials_[chunk].moment;
      barrier_energy += partials_[chunk].barrier_energy;
      barrier_frequency2_ = maximum(barrier_frequency2_, partials_[chunk].barrier_frequency2);
      for (std::size_t p = 0; p < planes; ++p) {
        actions.plane_force[p] += plane_partials_[chunk * planes + p];
      }
    }
    step.state.ledger[at(body)].barrier_energy = barrier_energy;
    hold_constraints(step.model, step.state, body, actions);
  }
}

void IslandSolver::accelerate_chunk(const Step& step, std::size_t chunk_index) {
  const model::Model& model = step.model;
  const Workspace& workspace = step.workspace;
  const Chunk& chunk = chunks_[chunk_index];
  Partial& partial = partials_[chunk_index];
  const bool loaded = !workspace.load.empty();
  const std::size_t planes = model.planes.size();
  const double half = step.half_dt();
  partial.force = {};
  partial.moment = {};
  partial.barrier_energy = 0.0;
  partial.barrier_frequency2 = 0.0;
  for (std::size_t p = 0; p < planes; ++p) {
    plane_partials_[chunk_index * planes + p] = {};
  }
  for (Index n = chunk.begin; n < chunk.end; ++n) {
    Vec3d internal, internal_moment;
    for (Index c = model.corner_start[at(n)]; c < model.corner_start[at(n) + 1]; ++c) {
      const CornerForce& corner = workspace.corner_force[at(model.corner[at(c)])];
      internal += corner.force;
      internal_moment += corner.moment;
    }
    Vec3d force = workspace.contact.force[at(n)] - internal;
    Vec3d moment = -internal_moment;
    const model::NodeMotion& motion = step.state.motion[at(n)];
    if (workspace.external) {
      NodalAction outside;
      if (loaded) {
        outside = workspace.load[at(n)];
        partial.external_work +=
            half * (dot(outside.force, motion.velocity) + dot(outside.moment, motion.rotation_rate));
      }
      double stiffness = 0.0;
      for (std::size_t p = 0; p < planes; ++p) {
        const PlaneReaction reaction = plane_reaction(model, model.planes[p], n, motion.position);
        outside.force += reaction.force;
        partial.barrier_energy += reaction.energy;
        stiffness += reaction.stiffness;
        plane_partials_[chunk_index * planes + p] += reaction.force;
      }
      partial.barrier_frequency2 = maximum(partial.barrier_frequency2, stiffness / model.mass[at(n)]);
      partial.force += outside.force;
      partial.moment += cross(motion.position, outside.force) + outside.moment;
      force += outside.force;
      moment += outside.moment;
    }
    step.state.acceleration[at(n)] = {(1.0 / model.mass[at(n)]) * force, (1.0 / model.inertia[at(n)]) * moment};
  }
}

void IslandSolver::closing_half(const Step& step) {
  parallel::for_each(static_cast<Index>(chunks_.size()), chunk_grain,
                     [&](Index i) { kick(step, chunks_[at(i)], partials_[at(i)]); });
  if (!step.workspace.external) {
    return;
  }
  prescribe(step, HalfStep::closing);
  const double half = step.half_dt();
  std::size_t chunk = 0;
  for (const Index body : bodies_) {
    const BodyActions& actions = step.workspace.actions[at(body)];
    model::BodyLedger& ledger = step.state.ledger[at(body)];
    ledger.external_impulse += half * actions.force;
    ledger.external_angular_impulse += half * actions.moment;
    for (; chunk < chunks_.size() && chunks_[chunk].body == body; ++chunk) {
      const Partial& partial = partials_[chunk];
      ledger.external_work += partial.external_work;
      ledger.damping_work += partial.damping_work;
      ledger.external_impulse += partial.impulse;
      ledger.external_angular_impulse += partial.angular_impulse;
    }
  }
}

void IslandSolver::record_hashes(const Step& step, std::int64_t number, std::vector<HashRecord>& hashes) const {
  contact_.store_sides(step.model, step.state);
  const std::size_t first = hashes.size();
  hashes.resize(first + bodies_.size());
  parallel::for_each(static_cast<Index>(bodies_.size()), body_grain, [&](Index i) {
    hashes[first + at(i)] = {number, bodies_[at(i)], model::body_hash(step.model, step.state, bodies_[at(i)])};
  });
}

}  // namespace fexp::solve
