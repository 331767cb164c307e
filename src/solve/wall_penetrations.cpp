// SPDX-License-Identifier: Apache-2.0
#include "solve/wall_penetrations.hpp"

#include "solve/walls.hpp"

namespace fexp::solve {

std::vector<WallPenetration> find_wall_penetrations(const model::Model& model) {
  constexpr double least_part = 1.0e-3;
  std::vector<WallPenetration> found;
  for (Index b = 0; b < model.meshed_body_count(); ++b) {
    const model::Body& body = model.bodies[at(b)];
    for (std::size_t w = 0; w < model.walls.size() && !body.barrier; ++w) {
      const model::Wall& wall = model.walls[w];
      WallPenetration deepest{b, static_cast<Index>(w), 0, no_index, 0.0, 0.0};
      for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
        const double half = model.half_thickness[at(n)];
        const double depth = half - wall_distance(wall, wall.point, model.reference_position[at(n)]).distance;
        if (depth > least_part * half) {
          ++deepest.count;
          if (depth > deepest.depth) {
            deepest.node = n;
            deepest.depth = depth;
            deepest.contact_distance = half;
          }
        }
      }
      if (deepest.count > 0) {
        found.push_back(deepest);
      }
    }
  }
  return found;
}

}  // namespace fexp::solve
