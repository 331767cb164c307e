// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "model/state.hpp"
#include "solve/island_solver.hpp"
#include "support/descriptions.hpp"

/// Small models for tests, ready to step.
namespace fexp::test {

/// The nodes of a set; no such set fails the test.
inline std::vector<Index> nodes_of(const model::Model& model, std::string_view set) {
  for (const model::NamedNodes& named : model.node_sets) {
    if (named.name == set) {
      return named.nodes;
    }
  }
  ADD_FAILURE() << "no set " << set;
  return {};
}

/// One island of all bodies, stepped directly: the step is the test's, and no guard interferes.
class DirectRun {
 public:
  explicit DirectRun(const model::Model& model, solve::KernelChoice kernel = solve::KernelChoice::automatic)
      : DirectRun(model, model::initial_state(model), kernel) {}

  /// Takes up a run at a state.
  DirectRun(const model::Model& model, model::State from, solve::KernelChoice kernel = solve::KernelChoice::automatic)
      : model_(model),
        state(std::move(from)),
        workspace(model, solve::select_element_kernel(kernel)),
        allowance_(model.bodies.size(), HUGE_VAL) {
    std::vector<Index> bodies;
    std::vector<Index> barriers;
    for (Index b = 0; b < model.body_count(); ++b) {
      (model.bodies[at(b)].barrier ? barriers : bodies).push_back(b);
    }
    island_.assign(model, workspace.patches, state, bodies, barriers);
    island_.evaluate(model, state, workspace);
  }

  /// `stop`: from rest.
  solve::IslandReport advance(double dt, Index steps, bool stop = false) {
    std::vector<solve::HashRecord> hashes;
    const double end_time = state.time + static_cast<double>(steps) * dt;
    const solve::EpochPlan plan{dt, steps, end_time, 0, allowance_, model_.run.damping, stop};
    const solve::IslandReport report = island_.advance(model_, state, workspace, plan, hashes);
    state.step += report.steps_done;
    state.time = report.steps_done == steps ? end_time : state.time + static_cast<double>(report.steps_done) * dt;
    return report;
  }

  /// Writes what only the island knows to the state.
  void store() { island_.store(model_, state); }

 private:
  const model::Model& model_;

 public:
  model::State state;
  solve::Workspace workspace;

 private:
  std::vector<double> allowance_;
  solve::IslandSolver island_;
};

}  // namespace fexp::test
