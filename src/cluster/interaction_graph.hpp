// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "model/model.hpp"

namespace fexp::cluster {

/// A connected component of the interaction graph: bodies that may touch each other during an epoch, and the barriers
/// they may touch. Both ascending.
struct Island {
  std::vector<Index> bodies;
  std::vector<Index> barriers;

  friend bool operator==(const Island&, const Island&) = default;
};

/// Islands of the macro-entity interaction graph [REK19, section 5]: bodies are vertices, and two bodies are joined
/// when their swept boxes overlap and the deck lets them touch, or when one is a rigid wall with mass that the other
/// may come to. Barriers belong to every island they may touch and join none. `swept`: each body's box over the epoch,
/// thickness included [length], shape [bodies]. `ties`: how many of each body's nodes are tied, which join it with
/// those that carry them, shape [bodies]; empty: all ties hold. Islands come in ascending order of their lowest body.
[[nodiscard]] std::vector<Island> find_islands(const model::Model& model, std::span<const Box> swept,
                                               std::span<const Index> ties = {});

}  // namespace fexp::cluster
