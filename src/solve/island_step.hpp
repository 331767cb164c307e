// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/island_solver.hpp"

namespace fexp::solve {

/// Operands of one step.
struct IslandSolver::Step {
  const model::Model& model;
  model::State& state;
  Workspace& workspace;
  double dt;        ///< [time]; 0: evaluate without moving
  double end_time;  ///< t(n+1) [time]
  double damping;   ///< [1/time]

  [[nodiscard]] double half_dt() const noexcept { return 0.5 * dt; }
  [[nodiscard]] double middle_time() const noexcept { return end_time - 0.5 * dt; }
};

/// So many of `count` pieces with `items` in all that a task has `wanted` items, about.
[[nodiscard]] constexpr Index grain(std::size_t count, Index items, Index wanted) noexcept {
  const auto pieces = static_cast<Index>(wanted * static_cast<std::int64_t>(count) / (items <= 0 ? wanted : items));
  return items <= 0 || pieces < 1 ? 1 : pieces;
}

/// Nodes per task in passes over nodes alone.
inline constexpr Index task_nodes = 512;
/// Bodies per task in passes over bodies.
inline constexpr Index body_grain = 8;

}  // namespace fexp::solve
