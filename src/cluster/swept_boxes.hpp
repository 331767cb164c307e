// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::cluster {

/// Where a body is and how fast it may leave: all that the interaction graph needs to know of it.
struct BodyExtent {
  /// The nodes, and what the body's remembered sides name, so that these are in one island however deep a node has come
  /// through [length].
  Box box;
  double size{};          ///< Largest edge of the nodes' box; of a rigid wall with mass, of that of all bodies [length]
  double reach{};         ///< Largest half thickness with the margin within which contact remembers sides [length]
  double speed{};         ///< Largest of the nodes [length/time]
  double acceleration{};  ///< Largest of the nodes [length/time^2]
};

[[nodiscard]] BodyExtent extent_of(const model::Model& model, const model::State& state, Index body);

/// How far the body's nodes are allowed to move in `steps` steps of `dt` before the epoch has to be redone [length]: a
/// bound from the velocities of the first half step, with a margin, plus a small part of the body's size so that bodies
/// at rest may start to move. A single step never needs more. Barriers get zero.
[[nodiscard]] double travel_allowance(const model::Model& model, Index body, const BodyExtent& extent, double dt,
                                      Index steps);

/// The body's present box grown by its allowance and the reach of contact [length].
[[nodiscard]] Box swept_box(const BodyExtent& extent, double allowance);

}  // namespace fexp::cluster
