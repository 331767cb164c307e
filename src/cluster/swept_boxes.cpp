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
constexpr Index node_piece = 4096;

/// Largest value of a curve, whichever its sign.
double largest_value(const model::Model& model, Index curve) {
  double largest = curve == no_index ? 1.0 : 0.0;
  if (curve != no_index) {
    for (const auto& point : model.curves[at(curve)].points) {
      largest = std::max(largest, std::abs(point[1]));
    }
  }
  return largest;
}

/// Largest slope of a curve, whichever its sign [1/time].
double largest_slope(const model::Model& model, Index curve) {
  double largest = 0.0;
  if (curve != no_index) {
    const auto& points = model.curves[at(curve)].points;
    for (std::size_t i = 1; i < points.size(); ++i) {
      largest = std::max(largest, std::abs((points[i][1] - points[i - 1][1]) / (points[i][0] - points[i - 1][0])));
    }
  }
  return largest;
}

/// Bound of the speed that the prescribed motion `p` gives within `span`, besides the speed there is [length/time] or
/// [1/time].
double prescribed_rate(const model::Model& model, const model::PrescribedNode& p, double span) {
  return std::abs(p.value) * (p.kind == model::PrescribedKind::displacement   ? largest_slope(model, p.curve)
                              : p.kind == model::PrescribedKind::acceleration ? largest_value(model, p.curve) * span
                                                                              : largest_value(model, p.curve));
}

/// Largest speed that prescribed motion can give a node of the body within `span`, besides the one it has, or a node at
/// the end of an arm at one of them [length/time].
double prescribed_speed(const model::Model& model, const model::Body& body, double span, double arm) {
  double translation = 0.0, turn = 0.0;
  for (Index i = body.prescribed.begin; i < body.prescribed.end; ++i) {
    const model::PrescribedNode& p = model.prescribed[at(i)];
    double& largest = p.angular() ? turn : translation;
    largest = std::max(largest, (p.angular() ? arm : 1.0) * prescribed_rate(model, p, span));
  }
  if (body.rigid != no_index) {
    const model::RigidBody& rigid = model.rigid_bodies[at(body.rigid)];
    for (const model::PrescribedNode& p : rigid.prescribed) {
      double& largest = p.angular() ? turn : translation;
      largest = std::max(largest, (p.angular() ? rigid.radius : 1.0) * prescribed_rate(model, p, span));
    }
  }
  // Up to three components of each may be prescribed.
  return std::sqrt(3.0) * (translation + turn);
}

/// The same with what nodes of the body have from those that they are tied to.
double driven_speed(const model::Model& model, Index body, double span) {
  double speed = prescribed_speed(model, model.bodies[at(body)], span, 0.0);
  const std::vector<model::TiedBodies>& bodies = model.ties.bodies;
  auto tied = std::lower_bound(bodies.begin(), bodies.end(), body,
                               [](const model::TiedBodies& pair, Index wanted) { return pair.body < wanted; });
  for (; tied != bodies.end() && tied->body == body; ++tied) {
    speed += prescribed_speed(model, model.bodies[at(tied->carrier)], span, tied->arm);
  }
  return speed;
}

double largest_edge(const Box& box) {
  return std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
}

}  // namespace

BodyExtent extent_of(const model::Model& model, const model::State& state, Index body) {
  // The root of the largest square is taken at the end.
  const auto part_of = [&](Index begin, Index end) {
    BodyExtent part;
    for (Index n = begin; n < end; ++n) {
      const model::NodeMotion& motion = state.motion[at(n)];
      const Vec3d& acceleration = state.acceleration[at(n)].linear;
      part.box.include(motion.position);
      part.reach = std::max(part.reach, model.half_thickness[at(n)] + model::watch_margin(model.node_size[at(n)]));
      part.speed = std::max(part.speed, dot(motion.velocity, motion.velocity));
      part.acceleration = std::max(part.acceleration, dot(acceleration, acceleration));
    }
    return part;
  };
  const auto larger = [](BodyExtent a, const BodyExtent& b) {
    a.box.include(b.box);
    a.reach = std::max(a.reach, b.reach);
    a.speed = std::max(a.speed, b.speed);
    a.acceleration = std::max(a.acceleration, b.acceleration);
    return a;
  };
  BodyExtent extent = parallel::ordered_fold(model.bodies[at(body)].nodes, node_piece, BodyExtent{}, part_of, larger);
  const Index wall = model.bodies[at(body)].wall;
  extent.size = wall == no_index ? largest_edge(extent.box) : model.walls[at(wall)].span;
  extent.speed = std::sqrt(extent.speed);
  extent.acceleration = std::sqrt(extent.acceleration);
  for (const model::ContactSide& side : state.sides[at(body)]) {
    extent.box.include(state.motion[at(side.node)].position);
    extent.box.include(state.motion[at(model.triangle[at(side.element)][0])].position);
  }
  for (const model::EdgeSide& side : state.edge_sides[at(body)]) {
    for (const Index edge : {side.first, side.second}) {
      extent.box.include(state.motion[at(model.triangle[at(edge / 3)][at(edge % 3)])].position);
    }
  }
  return extent;
}

double travel_allowance(const model::Model& model, Index body, const BodyExtent& extent, double dt, Index steps) {
  if (model.bodies[at(body)].barrier) {
    return 0.0;
  }
  const auto count = static_cast<double>(steps);
  const double speed = extent.speed + 0.5 * dt * extent.acceleration + driven_speed(model, body, dt * count);
  return velocity_margin * speed * dt * count + free_play * extent.size;
}

Box swept_box(const BodyExtent& extent, double allowance) { return extent.box.grown(allowance + extent.reach); }

}  // namespace fexp::cluster
