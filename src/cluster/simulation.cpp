// SPDX-License-Identifier: Apache-2.0
#include "cluster/simulation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <tuple>
#include <utility>

#include "base/hash.hpp"
#include "base/process_threads.hpp"
#include "base/stopwatch.hpp"
#include "parallel/parallel.hpp"
#include "physics/critical_step.hpp"
#include "solve/loads.hpp"

namespace fexp::cluster {

namespace {

/// The guard lets a changing model use up this part of the safety margin before it has an epoch redone.
constexpr double margin_used = 0.9;
/// Attempts at one epoch with a smaller step before the step counts as collapsed.
constexpr int most_attempts = 40;
/// A step equal to the stable one but for rounding is stable.
constexpr double rounding = 1.0 + 1.0e-9;

double frequency2(const solve::CriticalStep& critical) noexcept { return 4.0 / (critical.step * critical.step); }

/// Tells models apart: a snapshot fits the model that it was made with and no other.
std::uint64_t fingerprint(const model::Model& model) {
  const std::array<std::uint64_t, 3> parts{hash_bytes(std::as_bytes(std::span(model.reference_position))),
                                           hash_bytes(std::as_bytes(std::span(model.mass))),
                                           hash_bytes(std::as_bytes(std::span(model.triangle)))};
  ByteWriter out;
  out.value(parts);
  out.value(static_cast<std::uint64_t>(model.bodies.size()));
  if (!model.ties.empty()) {
    out.value(hash_bytes(std::as_bytes(std::span(model.ties.mass))));
  }
  out.value(model.run.duration);
  out.value(model.run.safety);
  return hash_bytes(out.bytes());
}

double relative(double error, double scale) noexcept { return scale > 0.0 ? std::abs(error) / scale : 0.0; }

}  // namespace

struct Simulation::Attempt {
  double dt{};
  Index steps{};
  double end_time{};              ///< The target's when the steps reach it
  Index most_steps{};             ///< Lowered when the guard trips.
  double contact_frequency2{};    ///< Raised when the guard trips.
  double element_frequency2{};    ///< Likewise.
  std::vector<double> allowance;  // [bodies]
};

/// No body placed or evaluated yet. Every rank has the whole state of the start, so the notices need not be told. Those
/// of barriers stay; of the other bodies only the extent is asked for before they are noticed anew.
Simulation::Simulation(const model::Model& model, solve::KernelChoice kernel, World world, Blank /*blank*/)
    : model_(model),
      fingerprint_(fingerprint(model)),
      world_(std::move(world)),
      state_(model::initial_state(model)),
      backup_(state_),
      workspace_(model, solve::select_element_kernel(kernel)),
      notices_(model.bodies.size()),
      owner_(model.bodies.size(), no_machine),
      arrived_(model.bodies.size(), true),
      loads_end_(model.run.is_static() ? end_of_curves(model) : 0.0),
      sudden_energy_(solve::sudden_load_energy(model, state_, model.first_step())),
      watchdog_(model.bodies.size()) {
  parallel::for_each(model_.body_count(), 1, [&](Index b) {
    if (model_.bodies[at(b)].barrier) {
      notices_[at(b)] = notice_of(model_, state_, state_, b);
    } else {
      notices_[at(b)].extent = extent_of(model_, state_, b);
      notices_[at(b)].ties = model_.bodies[at(b)].ties.size();
    }
  });
}

Simulation::Simulation(const model::Model& model, solve::KernelChoice kernel, World world)
    : Simulation(model, kernel, std::move(world), Blank{}) {
  Attempt still;
  still.allowance.assign(model_.bodies.size(), 0.0);
  form_islands(still);
  parallel::for_each(static_cast<Index>(solvers_.size()), 1, [&](Index i) {
    if (solvers_[at(i)]) {
      solvers_[at(i)]->store(model_, state_);
    }
  });
  share(RankRecord{}, std::vector<double>(islands_.size(), 0.0));
  critical_ = smallest_critical_step();
  start_ = sum_of_diagnostics();
  extremes_.fewest_islands = static_cast<Index>(islands_.size());
  begin_load();
}

EpochReport Simulation::present() const {
  EpochReport report;
  report.critical = critical_;
  report.islands = static_cast<Index>(islands_.size());
  report.diagnostics = sum_of_diagnostics();
  return report;
}

std::vector<double> Simulation::elements_of(const model::Model& model) {
  std::vector<double> elements;
  for (const model::Body& body : model.bodies) {
    elements.push_back(std::max(1.0, static_cast<double>(body.elements.size())));
  }
  return elements;
}

solve::CriticalStep Simulation::smallest_critical_step() const {
  solve::CriticalStep smallest;
  for (const BodyNotice& notice : notices_) {
    smallest = solve::smaller(smallest, notice.critical);
  }
  return smallest;
}

solve::Diagnostics Simulation::sum_of_diagnostics() const {
  solve::Diagnostics sum;
  for (const BodyNotice& notice : notices_) {
    sum += notice.diagnostics;
  }
  return sum;
}

/// Step and number of steps towards the target, which may be infinite, and how far the bodies may move meanwhile.
void Simulation::plan(double target, Attempt& attempt) const {
  const double frequency =
      physics::damped_frequency(attempt.element_frequency2, attempt.contact_frequency2, model_.run.stiffness_damping);
  const double part = state_.time < half_until_ ? 0.5 : 1.0;
  const double largest = part * model_.run.safety * 2.0 / frequency;
  const double left = target - state_.time;
  const double needed = std::ceil(left / largest);
  const double most =
      std::clamp(std::floor(relaxation_.longest_epoch() / largest), 1.0, static_cast<double>(attempt.most_steps));
  const bool reaches_target = needed <= most;
  attempt.steps = std::max(static_cast<Index>(reaches_target ? needed : most), Index{1});
  // The same step all the way: where steps change again and again, modes near the critical step grow.
  attempt.dt = std::isfinite(needed) ? left / std::max(needed, 1.0) : largest;
  attempt.end_time = reaches_target ? target : state_.time + static_cast<double>(attempt.steps) * attempt.dt;
  attempt.allowance.resize(model_.bodies.size());
  for (Index b = 0; b < model_.body_count(); ++b) {
    attempt.allowance[at(b)] = travel_allowance(model_, b, notices_[at(b)].extent, attempt.dt, attempt.steps);
  }
}

/// Finds the islands of the attempt and sees to it that every machine has its own.
void Simulation::form_islands(const Attempt& attempt) {
  std::vector<Box> swept(model_.bodies.size());
  for (std::size_t b = 0; b < swept.size(); ++b) {
    swept[b] = swept_box(notices_[b].extent, attempt.allowance[b]);
  }
  std::vector<Index> ties;
  for (std::size_t b = 0; b < swept.size() && model_.ties.can_break; ++b) {
    ties.push_back(notices_[b].ties);
  }
  std::vector<Island> islands = find_islands(model_, swept, ties);
  place(islands);
  take_up_solvers(std::move(islands));
  for (const Index body : own_bodies_) {
    model::copy_body(model_, state_, body, backup_);
  }
}

/// Steps this machine's islands, and tells all ranks what came of it.
RankRecord Simulation::advance_islands(const Attempt& attempt, std::int64_t hash_every, const Requests& requests,
                                       EpochReport& report) {
  std::vector<Index> order;
  for (Index i = 0; i < static_cast<Index>(solvers_.size()); ++i) {
    if (solvers_[at(i)]) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return solvers_[at(a)]->element_count() > solvers_[at(b)]->element_count();
  });
  const auto start = Clock::now();
  std::vector<solve::IslandReport> islands(order.size());
  std::vector<double> seconds(solvers_.size(), 0.0);
  std::vector<std::vector<solve::HashRecord>> hashes(order.size());
  const solve::EpochPlan plan{attempt.dt,         attempt.steps,     attempt.end_time,
                              hash_every,         attempt.allowance, model_.run.damping + relaxation_.damping(),
                              relaxation_.stops()};
  parallel::for_each(static_cast<Index>(order.size()), 1, [&](Index k) {
    solve::IslandSolver& solver = *solvers_[at(order[at(k)])];
    const auto island_start = Clock::now();
    islands[at(k)] = solver.advance(model_, state_, workspace_, plan, hashes[at(k)]);
    solver.store(model_, state_);
    seconds[at(order[at(k)])] = seconds_since(island_start);
  });
  RankRecord own;
  own.busy_seconds = seconds_since(start);
  own.requests = requests;
  // A folder of /proc is read, so it is done ever more seldom.
  own.running_threads = std::has_single_bit(static_cast<std::uint64_t>(load_.epochs + 1)) ? process_threads() : 0;
  for (const solve::IslandReport& island : islands) {
    own.add(island);
  }
  report.hashes.clear();
  for (const auto& list : hashes) {
    report.hashes.insert(report.hashes.end(), list.begin(), list.end());
  }
  return share(own, seconds);
}

void Simulation::put_back() {
  for (const Index body : own_bodies_) {
    model::copy_body(model_, backup_, body, state_);
  }
  notices_ = start_notices_;
  parallel::for_each(static_cast<Index>(solvers_.size()), 1, [&](Index i) {
    if (solvers_[at(i)]) {
      solvers_[at(i)]->assign(model_, workspace_.patches, state_, islands_[at(i)].bodies, islands_[at(i)].barriers);
      solvers_[at(i)]->evaluate(model_, state_, workspace_);
    }
  });
}

EpochReport Simulation::run_epoch(double target, std::int64_t hash_every, const Requests& requests) {
  EpochReport report;
  start_notices_ = notices_;
  backup_.step = state_.step;
  backup_.time = state_.time;
  const std::tuple before(critical_, contact_frequency2_, energy_scale_, linear_scale_, angular_scale_, relaxation_);
  step_before_ = 2.0 / std::sqrt(frequency2(critical_) + contact_frequency2_);
  attempt_epoch(target, hash_every, requests, report);
  if (report.fault.kind != FaultKind::none) {
    describe(report);
    if (is_curable(report)) {
      const EpochReport failed = std::exchange(report, {});
      state_.step = backup_.step;
      state_.time = backup_.time;
      put_back();
      if (failed.steps > 0) {
        watchdog_.take_back();
      }
      std::tie(critical_, contact_frequency2_, energy_scale_, linear_scale_, angular_scale_, relaxation_) = before;
      half_until_ = failed.end_time;
      report.retried = failed.fault;
      report.rollbacks = failed.rollbacks + 1;
      attempt_epoch(target, hash_every, requests, report);
      if (report.fault.kind != FaultKind::none) {
        describe(report);
      }
    }
  }
  if (hash_every > 0) {
    share_hashes(report);
  }
  extremes_.add(report);
  ++load_.epochs;
  return report;
}

/// One epoch, with as many roll-backs as the guard asks for, and its fault without words.
void Simulation::attempt_epoch(double target, std::int64_t hash_every, const Requests& requests, EpochReport& report) {
  Attempt attempt;
  // Of half steps twice as many, so that they lead as far.
  attempt.most_steps = state_.time < half_until_ ? 2 * model_.run.epoch_steps : model_.run.epoch_steps;
  attempt.contact_frequency2 = contact_frequency2_;
  attempt.element_frequency2 = frequency2(critical_);
  for (int tries = 0;; ++tries) {
    plan(target, attempt);
    report.end_time = attempt.end_time;
    form_islands(attempt);
    const RankRecord record = advance_islands(attempt, hash_every, requests, report);
    report.requests = record.requests;
    const Verdict verdict = guard(attempt, record, tries < most_attempts, report.fault);
    if (verdict != Verdict::accept) {
      put_back();
      ++report.rollbacks;
    }
    if (verdict == Verdict::give_up) {
      break;
    }
    if (verdict == Verdict::accept) {
      state_.step += attempt.steps;
      state_.time = attempt.end_time;
      report.dt = attempt.dt;
      report.steps = attempt.steps;
      gather(record, report);
      relax(attempt.dt);
      break;
    }
  }
  report.islands = static_cast<Index>(islands_.size());
  report.critical = critical_;
  judge(report);
}

/// Decides from global data whether an attempt stands; otherwise lowers what has to be lowered for the next one.
Simulation::Verdict Simulation::guard(Attempt& attempt, const RankRecord& record, bool may_retry, Fault& fault) {
  if (record.left_box) {
    // First of all, as whatever else went wrong may have come of a contact that was missed. A single step stays within:
    // its way is that of the first half step, which the allowance was made from.
    attempt.most_steps = std::max(attempt.steps / 2, Index{1});
    return Verdict::redo;
  }
  if (record.broken_node != no_index) {
    // The steps up to the one that failed are redone, so that the results end with the last sound state.
    if (fault.kind == FaultKind::none) {
      fault.kind = FaultKind::not_finite;
      fault.node = record.broken_node;
      fault.step = state_.step + record.broken_steps + 1;
    }
    attempt.most_steps = std::min(attempt.steps, record.good_steps);
    return may_halve() || attempt.most_steps == 0 ? Verdict::give_up : Verdict::redo;
  }
  const solve::CriticalStep critical = smallest_critical_step();
  const double element2 = frequency2(critical), contact2 = record.contact_frequency2;
  const double allowed = 2.0 * (1.0 - (1.0 - margin_used) * (1.0 - model_.run.safety));
  const bool collapsed =
      !(2.0 / std::sqrt(element2 + contact2) > model_.run.step_collapse * model_.first_critical_step);
  const double frequency = physics::damped_frequency(element2, contact2, model_.run.stiffness_damping);
  const bool stable = attempt.dt * frequency <= std::max(allowed, rounding * 2.0 * model_.run.safety);
  if (!stable && !collapsed && may_retry) {
    attempt.contact_frequency2 = std::max(attempt.contact_frequency2, contact2);
    attempt.element_frequency2 = std::max(attempt.element_frequency2, element2);
    return Verdict::redo;
  }
  critical_ = critical;
  contact_frequency2_ = contact2;
  if ((collapsed || !stable) && fault.kind == FaultKind::none) {
    fault.kind = collapsed ? FaultKind::step_collapsed : FaultKind::step_not_found;
  }
  return Verdict::accept;
}

/// How a static analysis is damped in the next epoch, and whether it has settled.
void Simulation::relax(double dt) {
  if (!model_.run.is_static()) {
    return;
  }
  RelaxationSums sums;
  for (const BodyNotice& notice : notices_) {
    sums += notice.relaxation;
  }
  relaxation_.add(sums, model_.run, {state_.time, dt, loads_end_});
}

void Simulation::gather(const RankRecord& record, EpochReport& report) const {
  report.active_pairs = record.active_pairs;
  report.candidates = record.candidates;
  report.searches = record.searches;
  report.deepest = record.deepest;
  report.deepest_node = record.deepest_node;
  report.deepest_element = record.deepest_element;
  report.contact_frequency2 = record.contact_frequency2;
  report.stiffest_node = record.stiffest_node;
  report.stiffest_element = record.stiffest_element;
  report.stiffest_wall = record.stiffest_wall;
  for (const Island& island : islands_) {
    Index elements = 0;
    for (const Index body : island.bodies) {
      elements += model_.bodies[at(body)].elements.size();
    }
    report.largest_island_elements = std::max(report.largest_island_elements, elements);
  }
}

/// Energy and momentum errors of the present state; the scales are the largest sums of moduli so far.
void Simulation::judge(EpochReport& report) {
  report.diagnostics = sum_of_diagnostics();
  const solve::Energies& e = report.diagnostics.energies;
  const solve::Momenta& m = report.diagnostics.momenta;
  energy_scale_ = std::max({energy_scale_, std::abs(e.external),
                            e.kinetic + std::abs(e.internal) + e.contact + e.barrier + e.damping + e.friction});
  linear_scale_ = std::max(linear_scale_, m.linear_scale);
  angular_scale_ = std::max(angular_scale_, m.angular_scale);
  // Off is what neither the energy nor what central differences keep of it accounts for: as long as there is little
  // energy, as where loads grow slowly, the two differ by much.
  const double change = e.balance() - start_.energies.balance();
  const double kept =
      0.125 * report.dt * report.dt * (report.diagnostics.acceleration_square - start_.acceleration_square);
  const double open = std::min(std::max(std::abs(change) - sudden_energy_, 0.0), std::abs(change - kept));
  report.energy_error = relative(open, energy_scale_);
  report.linear_momentum_error = relative(norm(m.linear - start_.momenta.linear - m.external_impulse), linear_scale_);
  report.angular_momentum_error =
      relative(norm(m.angular - start_.momenta.angular - m.external_angular_impulse), angular_scale_);
  if (report.fault.kind == FaultKind::none && !(report.energy_error <= model_.run.energy_drift_limit)) {
    report.fault.kind = FaultKind::energy_drift;
  }
  if (report.steps > 0) {
    watchdog_.add({state_.step, state_.time, report.dt, report.energy_error}, start_notices_, notices_);
  }
}

void RunExtremes::add(const EpochReport& report) {
  energy_error = std::max(energy_error, report.energy_error);
  linear_momentum_error = std::max(linear_momentum_error, report.linear_momentum_error);
  angular_momentum_error = std::max(angular_momentum_error, report.angular_momentum_error);
  if (report.steps > 0) {
    smallest_dt = std::min(smallest_dt, report.dt);
    largest_dt = std::max(largest_dt, report.dt);
  }
  fewest_islands = std::min(fewest_islands, report.islands);
  most_islands = std::max(most_islands, report.islands);
  most_active_pairs = std::max(most_active_pairs, report.active_pairs);
  deepest = std::max(deepest, report.deepest);
  searches += report.searches;
  rollbacks += report.rollbacks;
  retries += report.retried.kind != FaultKind::none ? 1 : 0;
  ++epochs;
}

}  // namespace fexp::cluster
