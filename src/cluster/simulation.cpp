// SPDX-License-Identifier: Apache-2.0
#include "cluster/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cluster/swept_boxes.hpp"
#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

/// The guard lets a changing model use up this part of the safety margin before it has an epoch redone.
constexpr double margin_used = 0.9;
/// Attempts at one epoch with a smaller step before the step counts as collapsed.
constexpr int most_attempts = 40;
/// A step equal to the stable one but for rounding is stable.
constexpr double rounding = 1.0 + 1.0e-9;

double frequency2(const solve::CriticalStep& critical) noexcept { return 4.0 / (critical.step * critical.step); }

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
  std::vector<Box> swept;         // [bodies]
};

Simulation::Simulation(const model::Model& model, solve::KernelChoice kernel)
    : model_(model), state_(model::initial_state(model)), workspace_(model, solve::select_element_kernel(kernel)) {
  critical_ = solve::critical_step(model_, state_);
  Attempt still;
  still.allowance.assign(model_.bodies.size(), 0.0);
  still.swept = swept_boxes(model_, state_, still.allowance);
  form_islands(still);
  parallel::for_each(static_cast<Index>(solvers_.size()), 1, [&](Index i) {
    solvers_[at(i)]->evaluate(model_, state_, workspace_);
    solvers_[at(i)]->store(model_, state_);
  });
  start_ = solve::diagnostics(model_, state_);
  extremes_.fewest_islands = static_cast<Index>(islands_.size());
}

EpochReport Simulation::present() const {
  EpochReport report;
  report.critical = critical_;
  report.islands = static_cast<Index>(islands_.size());
  report.diagnostics = solve::diagnostics(model_, state_);
  return report;
}

/// Step and number of steps towards the target, and what the bodies may sweep meanwhile.
void Simulation::plan(double target, Attempt& attempt) const {
  const double frequency2 = attempt.element_frequency2 + attempt.contact_frequency2;
  const double largest = model_.run.safety * 2.0 / std::sqrt(frequency2);
  const double left = target - state_.time;
  const double needed = std::ceil(left / largest);
  const bool reaches_target = needed <= static_cast<double>(attempt.most_steps);
  attempt.steps = reaches_target ? std::max(static_cast<Index>(needed), Index{1}) : attempt.most_steps;
  attempt.dt = reaches_target ? left / static_cast<double>(attempt.steps) : largest;
  attempt.end_time = reaches_target ? target : state_.time + static_cast<double>(attempt.steps) * attempt.dt;
  attempt.allowance = travel_allowance(model_, state_, attempt.dt, attempt.steps);
  attempt.swept = swept_boxes(model_, state_, attempt.allowance);
}

/// Finds the islands and keeps the solver of every island that is still the same.
void Simulation::form_islands(const Attempt& attempt) {
  std::vector<Island> islands = find_islands(model_, attempt.swept);
  std::vector<std::unique_ptr<solve::IslandSolver>> solvers(islands.size());
  // Both lists are in ascending order of their islands' lowest bodies.
  std::size_t old = 0;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    while (old < islands_.size() && islands_[old].bodies.front() < islands[i].bodies.front()) {
      ++old;
    }
    if (old < islands_.size() && islands_[old] == islands[i]) {
      solvers[i] = std::move(solvers_[old]);
    }
  }
  islands_ = std::move(islands);
  solvers_ = std::move(solvers);
  parallel::for_each(static_cast<Index>(islands_.size()), 1, [&](Index i) {
    if (!solvers_[at(i)]) {
      solvers_[at(i)] = std::make_unique<solve::IslandSolver>();
      solvers_[at(i)]->assign(model_, state_, islands_[at(i)].bodies, islands_[at(i)].barriers);
    }
  });
  island_of_body_.assign(model_.bodies.size(), no_index);
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    for (const Index body : islands_[i].bodies) {
      island_of_body_[at(body)] = static_cast<Index>(i);
    }
  }
}

std::vector<solve::IslandReport> Simulation::advance_islands(const Attempt& attempt, std::int64_t hash_every,
                                                             EpochReport& report) {
  const auto count = static_cast<Index>(solvers_.size());
  std::vector<solve::IslandReport> islands(solvers_.size());
  std::vector<std::vector<solve::HashRecord>> hashes(solvers_.size());
  std::vector<Index> order(solvers_.size());
  for (Index i = 0; i < count; ++i) {
    order[at(i)] = i;
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return solvers_[at(a)]->element_count() > solvers_[at(b)]->element_count();
  });
  const solve::EpochPlan plan{attempt.dt, attempt.steps, attempt.end_time, hash_every, attempt.allowance};
  parallel::for_each(count, 1, [&](Index k) {
    const std::size_t i = at(order[at(k)]);
    islands[i] = solvers_[i]->advance(model_, state_, workspace_, plan, hashes[i]);
    solvers_[i]->store(model_, state_);
  });
  report.hashes.clear();
  for (const auto& list : hashes) {
    report.hashes.insert(report.hashes.end(), list.begin(), list.end());
  }
  std::sort(report.hashes.begin(), report.hashes.end(), [](const solve::HashRecord& a, const solve::HashRecord& b) {
    return a.step != b.step ? a.step < b.step : a.body < b.body;
  });
  return islands;
}

void Simulation::put_back() {
  state_ = backup_;
  parallel::for_each(static_cast<Index>(solvers_.size()), 1, [&](Index i) {
    solvers_[at(i)]->assign(model_, state_, islands_[at(i)].bodies, islands_[at(i)].barriers);
    solvers_[at(i)]->evaluate(model_, state_, workspace_);
  });
}

EpochReport Simulation::run_epoch(double target, std::int64_t hash_every) {
  EpochReport report;
  Attempt attempt;
  attempt.most_steps = model_.run.epoch_steps;
  attempt.contact_frequency2 = contact_frequency2_;
  attempt.element_frequency2 = frequency2(critical_);
  backup_ = state_;
  for (int tries = 0;; ++tries) {
    plan(target, attempt);
    form_islands(attempt);
    const std::vector<solve::IslandReport> islands = advance_islands(attempt, hash_every, report);
    const Verdict verdict = guard(attempt, islands, tries < most_attempts, report.fault);
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
      gather(islands, report);
      break;
    }
  }
  report.islands = static_cast<Index>(islands_.size());
  report.critical = critical_;
  judge(report);
  return report;
}

/// Decides from global data whether an attempt stands; otherwise lowers what has to be lowered for the next one.
Simulation::Verdict Simulation::guard(Attempt& attempt, const std::vector<solve::IslandReport>& islands, bool may_retry,
                                      Fault& fault) {
  Index good = attempt.steps;
  bool left_box = false, broken = false;
  double contact2 = 0.0;
  for (const solve::IslandReport& island : islands) {
    good = std::min(good, island.steps_done);
    left_box = left_box || island.stop == solve::StopReason::left_swept_box;
    broken = broken || island.stop == solve::StopReason::not_finite;
    contact2 = std::max(contact2, island.contact_frequency2);
  }
  if (left_box) {
    // First of all, as whatever else went wrong may have come of a contact that was missed. A single step stays within:
    // its way is that of the first half step, which the allowance was made from.
    attempt.most_steps = std::max(attempt.steps / 2, Index{1});
    return Verdict::redo;
  }
  if (broken) {
    // The steps up to the one that failed are redone, so that the results end with the last sound state.
    if (fault.kind == FaultKind::none) {
      fault = not_finite_fault(islands);
    }
    attempt.most_steps = good;
    return good == 0 ? Verdict::give_up : Verdict::redo;
  }
  const solve::CriticalStep critical = solve::critical_step(model_, state_);
  const double element2 = frequency2(critical);
  const double allowed = 2.0 * (1.0 - (1.0 - margin_used) * (1.0 - model_.run.safety));
  const bool collapsed = !(critical.step > model_.run.step_collapse * model_.first_critical_step);
  const bool stable =
      attempt.dt * std::sqrt(element2 + contact2) <= std::max(allowed, rounding * 2.0 * model_.run.safety);
  if (!stable && !collapsed && may_retry) {
    attempt.contact_frequency2 = std::max(attempt.contact_frequency2, contact2);
    attempt.element_frequency2 = std::max(attempt.element_frequency2, element2);
    return Verdict::redo;
  }
  critical_ = critical;
  contact_frequency2_ = contact2;
  if ((collapsed || !stable) && fault.kind == FaultKind::none) {
    fault = collapsed_fault();
  }
  return Verdict::accept;
}

void Simulation::gather(const std::vector<solve::IslandReport>& islands, EpochReport& report) const {
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const solve::IslandReport& island = islands[i];
    report.active_pairs += island.active_pairs;
    report.candidates += island.candidates;
    report.searches += island.searches;
    report.largest_island_elements = std::max(report.largest_island_elements, solvers_[i]->element_count());
    if (island.deepest > report.deepest) {
      report.deepest = island.deepest;
      report.deepest_node = island.deepest_node;
      report.deepest_element = island.deepest_element;
    }
  }
}

/// Energy and momentum errors of the present state; the scales are the largest sums of moduli so far.
void Simulation::judge(EpochReport& report) {
  report.diagnostics = solve::diagnostics(model_, state_);
  const solve::Energies& e = report.diagnostics.energies;
  const solve::Momenta& m = report.diagnostics.momenta;
  energy_scale_ = std::max(
      {energy_scale_, std::abs(e.external), e.kinetic + std::abs(e.internal) + e.contact + e.barrier + e.damping});
  linear_scale_ = std::max(linear_scale_, m.linear_scale);
  angular_scale_ = std::max(angular_scale_, m.angular_scale);
  report.energy_error = relative(e.balance() - start_.energies.balance(), energy_scale_);
  report.linear_momentum_error = relative(norm(m.linear - start_.momenta.linear - m.external_impulse), linear_scale_);
  report.angular_momentum_error =
      relative(norm(m.angular - start_.momenta.angular - m.external_angular_impulse), angular_scale_);
  if (report.fault.kind == FaultKind::none && !(report.energy_error <= model_.run.energy_drift_limit)) {
    report.fault = energy_fault(report);
  }

  RunExtremes& x = extremes_;
  x.energy_error = std::max(x.energy_error, report.energy_error);
  x.linear_momentum_error = std::max(x.linear_momentum_error, report.linear_momentum_error);
  x.angular_momentum_error = std::max(x.angular_momentum_error, report.angular_momentum_error);
  if (report.steps > 0) {
    x.smallest_dt = std::min(x.smallest_dt, report.dt);
    x.largest_dt = std::max(x.largest_dt, report.dt);
  }
  x.fewest_islands = std::min(x.fewest_islands, report.islands);
  x.most_islands = std::max(x.most_islands, report.islands);
  x.most_active_pairs = std::max(x.most_active_pairs, report.active_pairs);
  x.deepest = std::max(x.deepest, report.deepest);
  x.searches += report.searches;
  x.rollbacks += report.rollbacks;
  ++x.epochs;
}

}  // namespace fexp::cluster
