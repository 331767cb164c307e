// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::cluster {

/// How far each body's nodes are allowed to move in `steps` steps of `dt` before the epoch has to be redone [length],
/// shape [bodies]: a bound from the velocities of the first half step, with a margin, plus a small part of the body's
/// size so that bodies at rest may start to move. A single step never needs more. Barriers get zero.
[[nodiscard]] std::vector<double> travel_allowance(const model::Model& model, const model::State& state, double dt,
                                                   Index steps);

/// Each body's present box grown by its allowance, its half thickness and the margin within which contact remembers
/// sides [length], shape [bodies]. A box reaches to every body that the body's remembered sides name, so that these are
/// in one island however deep a node has come through.
[[nodiscard]] std::vector<Box> swept_boxes(const model::Model& model, const model::State& state,
                                           std::span<const double> allowance);

}  // namespace fexp::cluster
