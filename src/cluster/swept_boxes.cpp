// SPDX-License-Identifier: Apache-2.0
#include "cluster/swept_boxes.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

/// Margin on the distance that the starting velocities give.
constexpr double velocity_margin = 1.25;
/// Free play, as a part of the body's largest extent: a hundredth keeps bodies apart in the graph until they are close.
constexpr double free_play = 0.01;
constexpr Index body_grain = 4;

/// Largest speed that prescribed motion can give a node of the body [length/time].
double prescribed_speed(const model::Model& model, const model::Body& body) {
  double largest = 0.0;
  for (Index i = body.prescribed.begin; i < body.prescribed.end; ++i) {
    const model::PrescribedNode& p = model.prescribed[at(i)];
    double factor = 1.0;
    if (p.curve != no_index) {
      factor = 0.0;
      for (const auto& point : model.curves[at(p.curve)].points) {
        factor = std::max(factor, std::abs(point[1]));
      }
    }
    largest = p.dof < 3 ? std::max(largest, std::abs(p.velocity) * factor) : largest;
  }
  // Up to three components of a node may be prescribed.
  return std::sqrt(3.0) * largest;
}

Box node_box(const model::Model& model, const model::State& state, const model::Body& body, double& reach) {
  Box box;
  reach = 0.0;
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    box.include(state.motion[at(n)].position);
    reach = std::max(reach, model.half_thickness[at(n)] + model::watch_margin(model.node_size[at(n)]));
  }
  return box;
}

double largest_extent(const Box& box) {
  return std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
}

}  // namespace

std::vector<double> travel_allowance(const model::Model& model, const model::State& state, double dt, Index steps) {
  std::vector<double> allowance(model.bodies.size(), 0.0);
  parallel::for_each(model.body_count(), body_grain, [&](Index b) {
    const model::Body& body = model.bodies[at(b)];
    if (body.barrier) {
      return;
    }
    double speed2 = 0.0;
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      const Vec3d v = state.motion[at(n)].velocity + (0.5 * dt) * state.acceleration[at(n)].linear;
      speed2 = std::max(speed2, dot(v, v));
    }
    const double speed = std::sqrt(speed2) + prescribed_speed(model, body);
    double reach = 0.0;
    const double size = largest_extent(node_box(model, state, body, reach));
    allowance[at(b)] = velocity_margin * speed * dt * static_cast<double>(steps) + free_play * size;
  });
  return allowance;
}

std::vector<Box> swept_boxes(const model::Model& model, const model::State& state, std::span<const double> allowance) {
  std::vector<Box> boxes(model.bodies.size());
  parallel::for_each(model.body_count(), body_grain, [&](Index b) {
    double reach = 0.0;
    Box box = node_box(model, state, model.bodies[at(b)], reach);
    for (const model::ContactSide& side : state.sides[at(b)]) {
      box.include(state.motion[at(side.node)].position);
      box.include(state.motion[at(model.triangle[at(side.element)][0])].position);
    }
    boxes[at(b)] = box.grown(allowance[at(b)] + reach);
  });
  return boxes;
}

}  // namespace fexp::cluster
