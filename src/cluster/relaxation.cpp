// SPDX-License-Identifier: Apache-2.0
#include "cluster/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

constexpr Index piece = 1024;

double ratio(double value, double largest) noexcept { return largest > 0.0 ? std::sqrt(value / largest) : 0.0; }

RelaxationSums plus(RelaxationSums a, const RelaxationSums& b) noexcept { return a += b; }

}  // namespace

RelaxationSums& RelaxationSums::operator+=(const RelaxationSums& other) noexcept {
  unbalanced += other.unbalanced;
  kinetic += other.kinetic;
  stiffness += other.stiffness;
  displacement += other.displacement;
  return *this;
}

RelaxationSums relaxation_sums(const model::Model& model, const model::State& before, const model::State& state,
                               Index body) {
  const auto sum = [&](Index begin, Index end) {
    RelaxationSums part;
    for (Index n = begin; n < end; ++n) {
      const double mass = model.mass[at(n)], inertia = model.inertia[at(n)];
      const model::NodeMotion& motion = state.motion[at(n)];
      const model::NodeAcceleration& a = state.acceleration[at(n)];
      const Vec3d way = motion.position - before.motion[at(n)].position;
      part.unbalanced += mass * dot(a.linear, a.linear) + inertia * dot(a.angular, a.angular);
      part.kinetic +=
          mass * dot(motion.velocity, motion.velocity) + inertia * dot(motion.rotation_rate, motion.rotation_rate);
      part.stiffness -= mass * dot(way, a.linear - before.acceleration[at(n)].linear);
      part.displacement += mass * dot(way, way);
    }
    return part;
  };
  return parallel::ordered_fold(model.bodies[at(body)].nodes, piece, RelaxationSums{}, sum, plus);
}

void Relaxation::add(const RelaxationSums& sums, const model::RunSettings& run, double time, double loads_end) {
  largest_unbalanced_ = std::max(largest_unbalanced_, sums.unbalanced);
  largest_kinetic_ = std::max(largest_kinetic_, sums.kinetic);
  residual_ = std::max(ratio(sums.unbalanced, largest_unbalanced_), ratio(sums.kinetic, largest_kinetic_));
  settled_ = residual_ <= run.residual && time >= loads_end;
  // Where the model has softened, or only moved as a whole, the last estimate stays.
  if (sums.stiffness > 0.0 && sums.displacement > 0.0) {
    damping_ = 2.0 * std::sqrt(sums.stiffness / sums.displacement);
  }
}

double end_of_curves(const model::Model& model) {
  double end = 0.0;
  const auto include = [&](Index curve) {
    if (curve != no_index) {
      end = std::max(end, model.curves[at(curve)].points.back()[0]);
    }
  };
  std::ranges::for_each(model.gravity, include, &model::GravityLoad::curve);
  std::ranges::for_each(model.forces, include, &model::NodeLoad::curve);
  std::ranges::for_each(model.pressure, include, &model::PressureLoad::curve);
  std::ranges::for_each(model.prescribed, include, &model::PrescribedNode::curve);
  std::ranges::for_each(model.walls, include, &model::Wall::curve);
  return end;
}

}  // namespace fexp::cluster
