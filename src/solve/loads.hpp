// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/workspace.hpp"

namespace fexp::solve {

/// Gravity, follower pressure and nodal forces on one body at `time` and the positions in `motion`; overwrites the
/// body's part of `load`, shape [nodes]. Nothing presses on elements that model::is_deleted says so of, with `layers`
/// those of the state and `still` where no step has been taken.
void evaluate_loads(const model::Model& model, const model::NodeMotion* motion, const double* layers, bool still,
                    double time, Index body, NodalAction* load);

/// Energy by which the balance of a sound run may be open because loads are there at once at time zero [force*length].
/// What central differences keep [BLM00, sec. 6.2.4 without damping] is the balance less sum dt^2 a.M a/8, and free
/// nodes get a = M^-1 f at once: sum dt^2 f.M^-1 f/8 over the nodes, `dt` the step, `start` the state at time zero.
[[nodiscard]] double sudden_load_energy(const model::Model& model, const model::State& start, double dt);

}  // namespace fexp::solve
