// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "contact/initial_penetrations.hpp"
#include "model/model.hpp"

namespace fexp::contact {

/// Nodes of a model, moved apart until nothing penetrates any more.
struct Separation {
  std::vector<Vec3d> position;  ///< Instead of the reference positions [length], shape [nodes]
  Index moved{};                ///< Nodes
  double largest_move{};        ///< [length]
  Index farthest_node{no_index};
  InitialPenetrations left;  ///< What could not be removed
};

/// Moves nodes by as little as it takes, each side of a pair alike. Nodes of barriers and rigid bodies and nodes with
/// conditions keep their places, and so do those whose elements would turn over, become slivers or cross others.
/// Crossings are not removed. Moves pair after pair in a fixed order, so that the result is the same on every machine.
[[nodiscard]] Separation separate(const model::Model& model, InitialPenetrations found);

}  // namespace fexp::contact
