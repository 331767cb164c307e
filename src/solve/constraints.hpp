// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/workspace.hpp"

namespace fexp::solve {

/// What prescribed motion took from or gave to a body in one half step.
struct PrescribedReport {
  Vec3d impulse;          ///< [force*time]
  Vec3d angular_impulse;  ///< About the origin [force*length*time]
  double work{};          ///< [force*length]
};

/// Which of the two half steps a prescribed velocity closes.
enum class HalfStep { opening, closing };

/// The velocity that a condition asks for at the end of a half step, along its direction [length/time] or [1/time].
/// `start`: the velocity at time zero, `way`: how far a translation has come [length]. A displacement asks for the
/// velocity that leads to it by the end of the step: from where the node is, so that nothing adds up; rotations, which
/// are not stored, by the curve's difference. At the end of a step its velocity is the slope of the curve.
[[nodiscard]] double prescribed_velocity(const model::Model& model, const model::PrescribedNode& p, double start,
                                         double way, HalfStep half, double time, double half_dt);

/// Sets prescribed velocities after a half step has been taken with the unconstrained acceleration. `time` is the end
/// of that half step (mid-step or step end) and `half_dt` its length. The work booked is that of the constraint force
/// over the step's displacement, so that it stands in the same balance as the other trapezoidal works, and what mass-
/// proportional damping has been booked for these components with the coefficient `damping` [1/time].
PrescribedReport prescribe_velocities(const model::Model& model, model::State& state, Index body, HalfStep half,
                                      double time, double half_dt, double damping);

/// Removes held components (fixed, symmetry) from the accelerations and adds the reactions to the body's actions.
/// Velocities, which start without them, are not touched: evaluating a state again leaves its bits as they are.
void hold_constraints(const model::Model& model, model::State& state, Index body, BodyActions& actions);

}  // namespace fexp::solve
