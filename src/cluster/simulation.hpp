// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cluster/interaction_graph.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/diagnostics.hpp"
#include "solve/island_solver.hpp"
#include "solve/workspace.hpp"

namespace fexp::cluster {

enum class FaultKind { none, not_finite, step_collapsed, energy_drift };

/// A physical failure of the run: what happened where, in one sentence, and the usual cure.
struct Fault {
  FaultKind kind{FaultKind::none};
  std::string message;
  std::string cure;
  Index body{no_index};
  Index element{no_index};
  Index node{no_index};
};

/// What one epoch did.
struct EpochReport {
  double dt{};  ///< [time]
  Index steps{};
  Index islands{};
  Index largest_island_elements{};
  Index rollbacks{};     ///< Times the epoch was put back and redone
  Index active_pairs{};  ///< Contacts at the end
  Index candidates{};
  Index searches{};  ///< Contact searches during the epoch
  double deepest{};  ///< Deepest penetration over contact distance [-]
  Index deepest_node{no_index};
  Index deepest_element{no_index};
  solve::CriticalStep critical;    ///< Of the elements, at the end
  solve::Diagnostics diagnostics;  ///< At the end
  double energy_error{};           ///< Relative imbalance at the end [-]
  double linear_momentum_error{};  ///< Relative to the sum of moduli [-]
  double angular_momentum_error{};
  std::vector<solve::HashRecord> hashes;  ///< By step, then body.
  Fault fault;
};

/// Largest values over the run.
struct RunExtremes {
  double energy_error{};
  double linear_momentum_error{};
  double angular_momentum_error{};
  double smallest_dt{HUGE_VAL};
  double largest_dt{};
  Index fewest_islands{};
  Index most_islands{};
  Index most_active_pairs{};
  double deepest{};
  std::int64_t epochs{};
  std::int64_t rollbacks{};
  std::int64_t searches{};
};

/// Integrates a model epoch by epoch on one machine. At an epoch's start the swept boxes of all bodies give the
/// interaction graph, its components are the islands, and the islands are stepped side by side. A guard checks
/// afterwards that no body left its swept box and that the step was stable; where it trips, the epoch is put back to
/// its start and redone shorter or with a smaller step.
class Simulation {
 public:
  Simulation(const model::Model& model, solve::KernelChoice kernel);

  /// Steps until `target` time or the end of one epoch, whichever comes first. `hash_every`: see EpochPlan.
  EpochReport run_epoch(double target, std::int64_t hash_every = 0);

  [[nodiscard]] const model::Model& model() const noexcept { return model_; }
  [[nodiscard]] const model::State& state() const noexcept { return state_; }
  [[nodiscard]] const solve::Workspace& workspace() const noexcept { return workspace_; }
  [[nodiscard]] const RunExtremes& extremes() const noexcept { return extremes_; }
  [[nodiscard]] const solve::Diagnostics& start() const noexcept { return start_; }
  /// Diagnostics, errors and contact counts of the present state.
  [[nodiscard]] EpochReport present() const;
  /// Island of each body (barriers: no_index), shape [bodies].
  [[nodiscard]] const std::vector<Index>& island_of_body() const noexcept { return island_of_body_; }

 private:
  struct Attempt;

  enum class Verdict { accept, redo, give_up };

  void plan(double target, Attempt& attempt) const;
  void form_islands(const Attempt& attempt);
  std::vector<solve::IslandReport> advance_islands(const Attempt& attempt, std::int64_t hash_every,
                                                   EpochReport& report);
  Verdict guard(Attempt& attempt, const std::vector<solve::IslandReport>& islands, bool may_retry, Fault& fault);
  void put_back();
  void gather(const std::vector<solve::IslandReport>& islands, EpochReport& report) const;
  void judge(EpochReport& report);

  [[nodiscard]] Fault not_finite_fault(const std::vector<solve::IslandReport>& islands) const;
  [[nodiscard]] Fault collapsed_fault() const;
  [[nodiscard]] Fault energy_fault(const EpochReport& report) const;

  const model::Model& model_;
  model::State state_;
  model::State backup_;
  solve::Workspace workspace_;
  std::vector<Island> islands_;
  std::vector<std::unique_ptr<solve::IslandSolver>> solvers_;  // [islands]
  std::vector<Index> island_of_body_;
  solve::CriticalStep critical_;  ///< Of the elements in the present state
  double contact_frequency2_{};   ///< Contact's share of omega^2 in the last epoch [1/time^2]
  solve::Diagnostics start_;
  double energy_scale_{};
  double linear_scale_{};
  double angular_scale_{};
  RunExtremes extremes_;
};

}  // namespace fexp::cluster
