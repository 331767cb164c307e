// SPDX-License-Identifier: Apache-2.0
#include "cluster/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::cluster {

namespace {

constexpr Index piece = 1024;

double ratio(double value, double largest) noexcept { return largest > 0.0 ? std::sqrt(value / largest) : 0.0; }

/// Takes components along the given directions out of translations and rotations: what is prescribed neither waits for
/// balance nor moves freely, and its reaction is no unbalanced force.
class FreePart {
 public:
  FreePart(const model::Model& model, Index body) : model_(model), range_(model.bodies[at(body)].prescribed) {}

  void reduce(Index node, Vec3d& linear, Vec3d& angular) const {
    const auto begin = model_.prescribed.begin() + range_.begin, end = model_.prescribed.begin() + range_.end;
    for (auto p = std::lower_bound(begin, end, node, [](const auto&a, Index n) { return a.node < n; });
         p != end && p->node == node; ++p) {
      Vec3d& part = p->dof < 3 ? linear : angular;
      part -= dot(part, p->direction) * p->direction;
    }
  }

 private:
  const model::Model& model_;
  IndexRange range_;
};

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
  const FreePart free(model, body);
  const auto sum = [&](Index begin, Index end) {
    RelaxationSums part;
    for (Index n = begin; n < end; ++n) {
      const double mass = model.mass[at(n)], inertia = model.inertia[at(n)];
      Vec3d force = state.acceleration[at(n)].linear, moment = state.acceleration[at(n)].angular;
      Vec3d velocity = state.motion[at(n)].velocity, rate = state.motion[at(n)].rotation_rate;
      Vec3d way = state.motion[at(n)].position - before.motion[at(n)].position;
      Vec3d change = force - before.acceleration[at(n)].linear;
      Vec3d no_rotation;
      free.reduce(n, force, moment);
      free.reduce(n, velocity, rate);
      free.reduce(n, way, no_rotation);
      free.reduce(n, change, no_rotation);
      part.unbalanced += mass * dot(force, force) + inertia * dot(moment, moment);
      part.kinetic += mass * dot(velocity, velocity) + inertia * dot(rate, rate);
      part.stiffness -= mass * dot(way, change);
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
