// SPDX-License-Identifier: Apache-2.0
#include "solve/loads.hpp"

#include <span>
#include <vector>

#include "base/vec3.hpp"

namespace fexp::solve {

void evaluate_loads(const model::Model& model, const model::NodeMotion* motion, const double* layers, bool still,
                    double time, Index body_index, NodalAction* load) {
  const model::Body& body = model.bodies[at(body_index)];
  Vec3d gravity;
  for (const model::GravityLoad& g : model.gravity) {
    gravity += curve_value(model, g.curve, time) * g.acceleration;
  }
  for (Index node = body.nodes.begin; node < body.nodes.end; ++node) {
    load[node] = {model.mass[at(node)] * gravity, {}};
  }
  for (Index i = body.forces.begin; i < body.forces.end; ++i) {
    const model::NodeLoad& nodal = model.forces[at(i)];
    const double factor = curve_value(model, nodal.curve, time);
    load[nodal.node].force += factor * nodal.force;
    load[nodal.node].moment += factor * nodal.moment;
  }
  for (Index i = body.pressure.begin; i < body.pressure.end; ++i) {
    const model::PressureLoad& pressure = model.pressure[at(i)];
    if (model::is_deleted(model, layers, pressure.element, still ? 1 : 0)) {
      continue;
    }
    const auto& nodes = model.triangle[at(pressure.element)];
    const Vec3d a = motion[nodes[1]].position - motion[nodes[0]].position;
    const Vec3d b = motion[nodes[2]].position - motion[nodes[0]].position;
    // cross(a, b) is twice the area along the normal; a third of the face's force goes to each corner.
    const double scale = -curve_value(model, pressure.curve, time) * pressure.value / 6.0;
    const Vec3d third = scale * cross(a, b);
    for (const Index node : nodes) {
      load[node].force += third;
    }
  }
}

namespace {

/// f.M^-1 f of the loads on a rigid body.
double sudden_square(const model::RigidBody& body, const model::RigidMotion& motion,
                     std::span<const model::NodeMotion> nodes, IndexRange range, std::span<const NodalAction> load) {
  Vec3d force, moment;
  for (Index n = range.begin; n < range.end; ++n) {
    force += load[at(n)].force;
    moment += cross(nodes[at(n)].position - motion.centre, load[at(n)].force) + load[at(n)].moment;
  }
  force = model::without(body.held, force);
  return dot(force, force) / body.mass + dot(moment, inverse_inertia_times(body, motion.orientation, moment));
}

}  // namespace

double sudden_load_energy(const model::Model& model, const model::State& start, double dt) {
  if (model.gravity.empty() && model.forces.empty() && model.pressure.empty()) {
    return 0.0;
  }
  std::vector<NodalAction> load(start.motion.size());
  double sum = 0.0;
  for (Index b = 0; b < model.body_count(); ++b) {
    const model::Body& body = model.bodies[at(b)];
    if (body.barrier) {
      continue;
    }
    evaluate_loads(model, start.motion.data(), start.layers.data(), true, 0.0, b, load.data());
    if (body.rigid != no_index) {
      sum += sudden_square(model.rigid_bodies[at(body.rigid)], start.rigid[at(body.rigid)], start.motion, body.nodes,
                           load);
      continue;
    }
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      const NodalAction& f = load[at(n)];
      sum += dot(f.force, f.force) / model.mass[at(n)] + dot(f.moment, f.moment) / model.inertia[at(n)];
    }
  }
  return 0.125 * dt * dt * sum;
}

}  // namespace fexp::solve
