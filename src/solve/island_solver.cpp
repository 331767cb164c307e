// SPDX-License-Identifier: Apache-2.0
#include "solve/island_solver.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/pack.hpp"
#include "parallel/parallel.hpp"
#include "solve/island_step.hpp"
#include "solve/rest.hpp"

namespace fexp::solve {

namespace {

/// Nodes of one piece of a border: small enough to balance, large enough that a piece is worth a task.
constexpr Index border_nodes = 256;
/// Elements per task.
constexpr Index task_elements = 1024;

}  // namespace

void IslandSolver::assign(const model::Model& model, const Patches& patches, const model::State& state,
                          std::span<const Index> bodies, std::span<const Index> barriers) {
  bodies_.assign(bodies.begin(), bodies.end());
  barriers_.assign(barriers.begin(), barriers.end());
  pieces_.clear();
  patch_pieces_.clear();
  border_pieces_.clear();
  rigid_pieces_.clear();
  rigid_.clear();
  walls_.clear();
  own_walls_.clear();
  rigid_nodes_ = 0;
  inertia_ratio_ = 1.0;
  elements_ = 0;
  nodes_ = 0;
  held_ = false;
  prescribed_ = false;
  for (const Index index : bodies_) {
    const model::Body& body = model.bodies[at(index)];
    const auto first_piece = static_cast<Index>(pieces_.size());
    elements_ += body.elements.size();
    nodes_ += body.nodes.size();
    prescribed_ = prescribed_ || body.prescribed.size() > 0;
    held_ = held_ || prescribed_ || body.fixed.size() > 0 || body.symmetry.size() > 0 || body.oblique.size() > 0;
    for (Index p = patches.body_patches[at(index)].begin; p < patches.body_patches[at(index)].end; ++p) {
      (body.rigid == no_index ? patch_pieces_ : rigid_pieces_).push_back(static_cast<Index>(pieces_.size()));
      pieces_.push_back({index, p, patches.inner_node.data(), patches.patches[at(p)].nodes});
    }
    const IndexRange border = patches.body_border[at(index)];
    if (body.wall != no_index) {
      // Neither a patch nor a border: its node waits for the forces of all others, as held ones do.
      held_ = true;
      own_walls_.push_back(body.wall);
      pieces_.push_back({index, no_index, patches.border_node.data(), border});
      continue;
    }
    for (Index begin = border.begin; begin < border.end; begin += border_nodes) {
      (body.rigid == no_index ? border_pieces_ : rigid_pieces_).push_back(static_cast<Index>(pieces_.size()));
      pieces_.push_back(
          {index, no_index, patches.border_node.data(), {begin, std::min(begin + border_nodes, border.end)}});
    }
    if (body.rigid != no_index) {
      rigid_.push_back({body.rigid, {first_piece, static_cast<Index>(pieces_.size())}, {}});
      rigid_nodes_ += body.nodes.size();
      inertia_ratio_ = maximum(inertia_ratio_, model.rigid_bodies[at(body.rigid)].inertia_ratio);
    }
  }
  assign_ties(model, state);
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const auto wall = static_cast<Index>(w);
    if (model.walls[w].body == no_index || std::ranges::find(own_walls_, wall) != own_walls_.end()) {
      walls_.push_back(wall);
    }
  }
  partials_.resize(pieces_.size());
  wall_partials_.assign(pieces_.size() * model.walls.size(), {});
  touches_.assign(pieces_.size() * model.walls.size(), {});
  wall_points_.resize(model.walls.size());
  wall_ways_.resize(model.walls.size());
  travelled_.resize(bodies_.size());
  // Walls with mass, the last of the bodies, have no surface that contact knows.
  contact_.assign(model, std::span<const Index>(bodies_).first(bodies_.size() - own_walls_.size()), barriers_, state);
  contact_report_ = {};
  contact_written_ = true;
}

void IslandSolver::evaluate(const model::Model& model, model::State& state, Workspace& workspace) {
  evaluate(Step{model, state, workspace, 0.0, state.time, 0.0});
}

void IslandSolver::evaluate(const Step& still) {
  for (Partial& partial : partials_) {
    partial = {};
  }
  take_up_masses(still);
  move_walls(still);
  clear_contact(still);
  contact_forces(still);
  if (!still.workspace.load.empty()) {
    load_nodes(still);
  }
  advance_pieces(still, Pass::accelerate);
  carry_ties(still);
  act_on_bodies(still);
  accelerate_rigid(still);
  rate_rigid_nodes(still);
  rate_ties(still);
}

IslandReport IslandSolver::advance(const model::Model& model, model::State& state, Workspace& workspace,
                                   const EpochPlan& plan, std::vector<HashRecord>& hashes) {
  IslandReport total;
  std::fill(travelled_.begin(), travelled_.end(), 0.0);
  const double start_time = state.time;
  const Index searches_before = contact_report_.searches;
  if (plan.stop) {
    parallel::for_each(static_cast<Index>(bodies_.size()), body_grain,
                       [&](Index i) { bring_to_rest(model, state, bodies_[at(i)]); });
  }
  bool opened = false;
  for (Index i = 0; i < plan.steps; ++i) {
    // The last step ends at the very time of the state after it, so that loads evaluated anew there are the same.
    const double end_time = i + 1 == plan.steps ? plan.end_time : start_time + static_cast<double>(i + 1) * plan.dt;
    const Step step{model, state, workspace, plan.dt, end_time, plan.damping};
    if (can_break_) {
      break_ties(step, i == 0 ? start_time : start_time + static_cast<double>(i) * plan.dt);
    }
    if (!opened) {
      opening_half(step);
    }
    if (!check_opened(step, total) || !check_motion(step, plan, total)) {
      return total;
    }
    contact_forces(step);
    const bool hash_due = plan.hash_every > 0 && (state.step + i + 1) % plan.hash_every == 0;
    opened = !workspace.external && !hash_due && i + 1 < plan.steps;
    if (workspace.external) {
      if (!workspace.load.empty()) {
        load_nodes(step);
      }
      // Held nodes are seen to before velocities change.
      advance_pieces(step, held_ ? Pass::accelerate : Pass::accelerate_and_close);
      carry_ties(step);
      act_on_bodies(step);
      accelerate_rigid(step);
      if (held_) {
        close_pieces(step);
      }
      book_closing_half(step);
    } else {
      advance_pieces(step, opened ? Pass::close_and_open : Pass::close);
      accelerate_rigid(step);
    }
    finish_rigid(step, opened);
    rate_ties(step);
    if (!check_closed(step, total)) {
      return total;
    }

    total.steps_done = i + 1;
    total.active_pairs = contact_report_.active_pairs;
    total.most_active_pairs = std::max(total.most_active_pairs, contact_report_.active_pairs);
    const double frequency2 = inertia_ratio_ * (contact_report_.max_stiffness_over_mass + barrier_frequency2_);
    if (total.contact_frequency2 < frequency2) {
      total.contact_frequency2 = frequency2;
      const bool by_wall = barrier_frequency2_ > contact_report_.max_stiffness_over_mass;
      total.stiffest_node = by_wall ? barrier_node_ : contact_report_.stiffest_node;
      total.stiffest_element = by_wall ? no_index : contact_report_.stiffest_element;
      total.stiffest_wall = by_wall ? barrier_wall_ : no_index;
    }
    total.candidates = contact_report_.candidates;
    total.searches = contact_report_.searches - searches_before;
    if (contact_report_.deepest > total.deepest) {
      total.deepest = contact_report_.deepest;
      total.deepest_node = contact_report_.deepest_node;
      total.deepest_element = contact_report_.deepest_element;
    }
    if (hash_due) {
      record_hashes(step, state.step + i + 1, hashes);
    }
  }
  return total;
}

/// One half step of velocities, v += dt/2 a. Mass-proportional damping scales them afterwards, so that it needs no
/// memory of its force and its work is exactly the kinetic energy it takes.
void IslandSolver::kick(const Step& step, const Piece& piece, Partial& partial) {
  const double half = step.half_dt();
  const double damping = step.damping;
  const double kept = 1.0 / (1.0 + damping * half);
  for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
    const Index n = piece.node[i];
    model::NodeMotion& motion = step.state.motion[at(n)];
    const model::NodeAcceleration& acceleration = step.state.acceleration[at(n)];
    Vec3d v = motion.velocity + half * acceleration.linear;
    Vec3d w = motion.rotation_rate + half * acceleration.angular;
    if (damping > 0.0) {
      const double mass = moving_mass(step.model, step.state, n), inertia = moving_inertia(step.model, step.state, n);
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
    move_walls(step);
    for (const Index body : bodies_) {
      const BodyActions& actions = step.workspace.actions[at(body)];
      model::BodyLedger& ledger = step.state.ledger[at(body)];
      ledger.external_work += half_work_of_walls(actions);
      ledger.external_impulse += half * actions.force;
      ledger.external_angular_impulse += half * actions.moment;
    }
  }
  open_pieces(step);
  follow_walls(step);
}

/// The opening half step of all nodes, and their motion.
void IslandSolver::open_pieces(const Step& step) {
  const auto count = static_cast<Index>(pieces_.size());
  const Index pieces_per_task = grain(pieces_.size(), nodes_, task_nodes);
  // One pass over the nodes unless prescribed or tied velocities come in between.
  const bool in_one = !prescribed_ && ties_.empty();
  open_rigid(step);
  parallel::for_each(count, pieces_per_task, [&](Index i) {
    if (is_rigid(step, at(i))) {
      return;
    }
    partials_[at(i)] = {};
    kick(step, pieces_[at(i)], partials_[at(i)]);
    if (in_one) {
      move(step, pieces_[at(i)], partials_[at(i)]);
    }
  });
  if (in_one) {
    return;
  }
  prescribe(step, HalfStep::opening);
  steer_ties(step);
  parallel::for_each(count, pieces_per_task, [&](Index i) {
    if (!is_rigid(step, at(i))) {
      move(step, pieces_[at(i)], partials_[at(i)]);
    }
  });
  place_ties(step);
}

/// The motion of a step, and the work that loads do in its first half.
void IslandSolver::move(const Step& step, const Piece& piece, Partial& partial) {
  const double half = step.half_dt();
  double largest = 0.0;
  for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
    const Index n = piece.node[i];
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
}

void IslandSolver::prescribe(const Step& step, HalfStep half) {
  if (!prescribed_) {
    return;
  }
  const double time = half == HalfStep::opening ? step.middle_time() : step.end_time;
  for (const Index body : bodies_) {
    const PrescribedReport report =
        prescribe_velocities(step.model, step.state, body, half, time, step.half_dt(), step.damping);
    model::BodyLedger& ledger = step.state.ledger[at(body)];
    ledger.external_work += report.work;
    ledger.external_impulse += report.impulse;
    ledger.external_angular_impulse += report.angular_impulse;
  }
}

bool IslandSolver::check_opened(const Step& step, IslandReport& report) const {
  return std::ranges::all_of(partials_, &Partial::finite) || find_broken(step, report);
}

bool IslandSolver::check_closed(const Step& step, IslandReport& report) const {
  return std::ranges::all_of(partials_, &Partial::closing_finite) || find_broken(step, report);
}

/// False, with the lowest node whose velocity is not finite. A square that overflows counts as well.
bool IslandSolver::find_broken(const Step& step, IslandReport& report) const {
  report.stop = StopReason::not_finite;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    if (partials_[p].finite && partials_[p].closing_finite) {
      continue;
    }
    for (Index i = piece.nodes.begin; i < piece.nodes.end; ++i) {
      const Index n = piece.node[i];
      const model::NodeMotion& motion = step.state.motion[at(n)];
      const double squares = dot(motion.velocity, motion.velocity) + dot(motion.rotation_rate, motion.rotation_rate);
      if (squares - squares != 0.0 && (report.stop_node == no_index || n < report.stop_node)) {
        report.stop_body = piece.body;
        report.stop_node = n;
      }
    }
  }
  return false;
}

/// False when a body may have left its swept box; otherwise tells contact how far nodes have moved.
bool IslandSolver::check_motion(const Step& step, const EpochPlan& plan, IslandReport& report) {
  double largest = 0.0;
  std::size_t piece = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    double speed2 = 0.0;
    for (; piece < pieces_.size() && pieces_[piece].body == bodies_[b]; ++piece) {
      speed2 = std::max(speed2, partials_[piece].largest_speed2);
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
  clear_contact(step);
  contact_.book_half_work(step.model, step.state, step.dt, step.workspace.body_contact.data());
  contact_.advance(step.model, step.state, largest);
  return true;
}

void IslandSolver::clear_contact(const Step& step) {
  for (const Index index : bodies_) {
    step.workspace.body_contact[at(index)] = {};
  }
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
  contact_report_ =
      contact_.evaluate(step.model, step.state, step.dt, step.workspace.contact, step.workspace.body_contact.data());
  contact_written_ = contact_report_.active_pairs > 0;
  for (const Index index : bodies_) {
    const contact::BodyContact& contact = step.workspace.body_contact[at(index)];
    step.state.ledger[at(index)].contact_energy = contact.energy;
    step.state.ledger[at(index)].contact_dissipation += contact.dissipated;
    step.state.ledger[at(index)].contact_work += contact.work;
  }
}

/// Element forces and what the pass makes of them: patch by patch, each with its inner nodes while the forces are in
/// the cache, then the nodes of borders.
void IslandSolver::advance_pieces(const Step& step, Pass pass) {
  parallel::for_each(static_cast<Index>(patch_pieces_.size()), grain(patch_pieces_.size(), elements_, task_elements),
                     [&](Index i) { advance_patch(step, pass, at(patch_pieces_[at(i)])); });
  NodeKernelArguments border = node_arguments(step, pass);
  border.force = step.workspace.border_force.data();
  border.force_start = step.workspace.patches.border_start.data();
  parallel::for_each(static_cast<Index>(border_pieces_.size()), 1,
                     [&](Index i) { advance_nodes(step, pass, border, at(border_pieces_[at(i)])); });
  sum_rigid_pieces(step);
}

void IslandSolver::advance_patch(const Step& step, Pass pass, std::size_t piece) {
  // Bytes, because setting all of them to zero would cost more than those that are used.
  alignas(NodeForce) std::array<std::byte, at(most_patch_forces) * sizeof(NodeForce)> storage;
  auto* const force = reinterpret_cast<NodeForce*>(storage.data());
  const Patches& patches = step.workspace.patches;
  const Patch& patch = patches.patches[at(pieces_[piece].patch)];
  std::fill_n(force, patch.force_count(), NodeForce{});
  step.workspace.kernel.elements(
      {step.state.motion.data(), step.model.triangle.data(), step.model.blocks.data(), step.workspace.sections.data(),
       step.state.history.data(), patches.corner.data(), force, step.dt, step.model.sections.data(),
       step.state.layers.data(), step.state.damping.empty() ? nullptr : step.state.damping.data(),
       step.model.run.stiffness_damping},
      patch.blocks.begin, patch.blocks.end);
  const NodeForce* share = force + patch.nodes.size();
  for (Index i = patch.border.begin; i < patch.border.end; ++i) {
    step.workspace.border_force[at(patches.border_place[at(i)])] = *share++;
  }
  NodeKernelArguments inner = node_arguments(step, pass);
  inner.force = force;
  advance_nodes(step, pass, inner, piece);
}

NodeKernelArguments IslandSolver::node_arguments(const Step& step, Pass pass) const {
  NodeKernelArguments arguments;
  arguments.contact_force = contact_written_ ? step.workspace.contact.force.data() : nullptr;
  arguments.inverse_inertia = step.workspace.inverse_inertia.data();
  arguments.motion = step.state.motion.data();
  arguments.acceleration = step.state.acceleration.data();
  arguments.half_dt = step.half_dt();
  arguments.dt = step.dt;
  arguments.go_on = pass == Pass::close_and_open;
  return arguments;
}

void IslandSolver::advance_nodes(const Step& step, Pass pass, const NodeKernelArguments& arguments, std::size_t index) {
  const Piece& piece = pieces_[index];
  if (pass == Pass::accelerate || pass == Pass::accelerate_and_close) {
    accelerate(step, arguments, index);
    if (pass == Pass::accelerate_and_close) {
      close(step, index);
    }
    return;
  }
  const NodeKernelReport report =
      step.workspace.kernel.nodes(arguments, piece.node, piece.nodes.begin, piece.nodes.end);
  Partial& partial = partials_[index];
  partial.closing_finite = report.closing_finite;
  partial.finite = report.opening_finite;
  partial.largest_speed2 = report.largest_speed2;
}

bool IslandSolver::is_rigid(const Step& step, std::size_t piece) const {
  return !rigid_.empty() && step.model.bodies[at(pieces_[piece].body)].rigid != no_index;
}

/// The closing half step of one piece where something acts from outside.
void IslandSolver::close(const Step& step, std::size_t piece) {
  partials_[piece].finite = true;
  kick(step, pieces_[piece], partials_[piece]);
  partials_[piece].closing_finite = partials_[piece].finite;
}

void IslandSolver::close_pieces(const Step& step) {
  parallel::for_each(static_cast<Index>(pieces_.size()), grain(pieces_.size(), nodes_, task_nodes), [&](Index i) {
    if (!is_rigid(step, at(i))) {
      close(step, at(i));
    }
  });
}

void IslandSolver::record_hashes(const Step& step, std::int64_t number, std::vector<HashRecord>& hashes) const {
  store(step.model, step.state);
  const std::size_t first = hashes.size();
  hashes.resize(first + bodies_.size());
  parallel::for_each(static_cast<Index>(bodies_.size()), body_grain, [&](Index i) {
    hashes[first + at(i)] = {number, bodies_[at(i)], model::body_hash(step.model, step.state, bodies_[at(i)])};
  });
}

}  // namespace fexp::solve
