// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "model/model.hpp"
#include "model/state.hpp"

/// Models and states filled by formula, so that what was written can be computed again by whoever reads it: other
/// C++ code, or Python. All formulas use + - * / on small integers only.
namespace fexp::test {

/// Value in [-1, 1) of a node or element, a component and a frame.
inline double made_up(std::int64_t item, std::int64_t component, std::int64_t frame) {
  return static_cast<double>((item * 37 + component * 53 + frame * 11) % 128 - 64) / 64.0;
}

/// `bodies` flat strips of `cells` squares, two triangles each, one above the other at distance 2. Thickness 0.125.
inline model::Model strips(Index bodies, Index cells) {
  model::Model model;
  model.sections.push_back({"s", physics::LinearElastic{}, {}, 1.0, 0.125});
  for (Index b = 0; b < bodies; ++b) {
    model::Body body;
    body.name = "strip[" + std::to_string(b) + "]";
    body.nodes = {model.node_count(), model.node_count() + 2 * (cells + 1)};
    body.elements = {model.element_count(), model.element_count() + 2 * cells};
    body.blocks.begin = model.block_count();
    for (Index i = 0; i <= cells; ++i) {
      for (Index j = 0; j < 2; ++j) {
        model.reference_position.push_back({static_cast<double>(i), static_cast<double>(j), 2.0 * b});
        model.node_body.push_back(b);
        model.node_label.push_back(1000 + model.node_count());
      }
    }
    for (Index e = 0; e < 2 * cells; ++e) {
      const Index corner = body.nodes.begin + 2 * (e / 2);
      model.triangle.push_back(e % 2 == 0 ? std::array<Index, 3>{corner, corner + 2, corner + 3}
                                          : std::array<Index, 3>{corner, corner + 3, corner + 1});
      model.reference_area.push_back(0.5);
      model.element_label.push_back(5000 + model.element_count());
      if (e % model::block_lanes == 0) {
        model.blocks.push_back({body.elements.begin + e, 0, 0, b});
      }
      ++model.blocks.back().count;
      model.element_block.push_back(model.block_count() - 1);
    }
    body.blocks.end = model.block_count();
    model.bodies.push_back(body);
  }
  model.initial_velocity.resize(model.reference_position.size());
  model.initial_rotation_rate.resize(model.reference_position.size());
  return model;
}

/// The state of a frame: step 10 x frame, time frame / 8, everything else made up.
inline model::State strip_state(const model::Model& model, std::int64_t frame) {
  model::State state = model::initial_state(model);
  state.step = 10 * frame;
  state.time = static_cast<double>(frame) / 8.0;
  const auto vector = [frame](Index item, std::int64_t first) {
    return Vec3d{made_up(item, first, frame), made_up(item, first + 1, frame), made_up(item, first + 2, frame)};
  };
  for (Index n = 0; n < model.node_count(); ++n) {
    state.motion[at(n)].position = model.reference_position[at(n)] + vector(n, 0);
    state.motion[at(n)].velocity = vector(n, 3);
    state.motion[at(n)].rotation_rate = vector(n, 6);
  }
  for (Index b = 0; b < model.block_count(); ++b) {
    for (Index row = 0; row < model::element_rows; ++row) {
      for (Index lane = 0; lane < model.blocks[at(b)].count; ++lane) {
        state.history[at((b * model::element_rows + row) * model::block_lanes + lane)] =
            made_up(model.blocks[at(b)].first + lane, row, frame);
      }
    }
  }
  return state;
}

}  // namespace fexp::test
