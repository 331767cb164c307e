// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/model.hpp"
#include "model/state.hpp"
#include "quality/edge_cuts.hpp"

/// Whether surfaces have come through each other.
namespace fexp::test {

inline quality::Surfaces surfaces_of(const model::Model& model) {
  return {{model.triangle.begin(), model.triangle.end()},
          {model.node_body.begin(), model.node_body.end()},
          model.body_count()};
}

inline std::vector<Vec3d> positions_of(const model::State& state) {
  std::vector<Vec3d> positions;
  positions.reserve(state.motion.size());
  for (const model::NodeMotion& motion : state.motion) {
    positions.push_back(motion.position);
  }
  return positions;
}

/// Edges that go through triangles.
inline int crossings(const model::Model& model, const model::State& state) {
  const std::vector<char> alive(model.triangle.size(), 1);
  return static_cast<int>(quality::find_edge_cuts(surfaces_of(model), positions_of(state), alive).size());
}

}  // namespace fexp::test
