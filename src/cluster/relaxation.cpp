// SPDX-License-Identifier: Apache-2.0
#include "cluster/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.hpp"
#include "solve/rest.hpp"

namespace fexp::cluster {

namespace {

constexpr Index piece = 1024;

/// An epoch under kinetic damping is this part of the motion, so that a stop comes soon after the peak [rad].
constexpr double epoch_phase = 0.25;
/// Of viscous damping beside kinetic damping, as a part of the critical one [decision 0021].
constexpr double part_of_critical = 0.3;
/// A residual that is smaller by this factor is progress.
constexpr double progress = 0.5;

double ratio(double value, double largest) noexcept { return largest > 0.0 ? std::sqrt(value / largest) : 0.0; }

RelaxationSums plus(RelaxationSums a, const RelaxationSums& b) noexcept { return a += b; }

}  // namespace

RelaxationSums& RelaxationSums::operator+=(const RelaxationSums& other) noexcept {
  unbalanced += other.unbalanced;
  kinetic += other.kinetic;
  stiffness += other.stiffness;
  displacement += other.displacement;
  power += other.power;
  return *this;
}

RelaxationSums relaxation_sums(const model::Model& model, const model::State& before, const model::State& state,
                               Index body) {
  // What is prescribed neither waits for balance nor moves freely, and its reaction is no unbalanced force.
  const solve::FreePart free(model, body);
  const auto sum = [&](Index begin, Index end) {
    RelaxationSums part;
    for (Index n = begin; n < end; ++n) {
      const double mass = moving_mass(model, state, n), inertia = moving_inertia(model, state, n);
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
      part.power += mass * dot(velocity, force) + inertia * dot(rate, moment);
    }
    return part;
  };
  return parallel::ordered_fold(model.bodies[at(body)].nodes, piece, RelaxationSums{}, sum, plus);
}

void Relaxation::add(const RelaxationSums& sums, const model::RunSettings& run, const EpochTimes& times) {
  const double time = times.end, loads_end = times.loads_end;
  largest_unbalanced_ = std::max(largest_unbalanced_, sums.unbalanced);
  largest_kinetic_ = std::max(largest_kinetic_, sums.kinetic);
  residual_ = std::max(ratio(sums.unbalanced, largest_unbalanced_), ratio(sums.kinetic, largest_kinetic_));
  settled_ = residual_ <= run.residual && time >= loads_end;
  // Where the model has softened, or only moved as a whole, the last estimate stays.
  if (sums.stiffness > 0.0 && sums.displacement > 0.0) {
    frequency_ = std::sqrt(sums.stiffness / sums.displacement);
  }
  if (run.relaxation == "automatic") {
    choose(time, time >= loads_end);
  } else {
    method_ = run.relaxation == "viscous" ? Method::viscous : Method::kinetic;
  }
  time_ = time;
  const bool kinetic = method_ != Method::viscous;
  damping_ = 2.0 * frequency_ * (!kinetic ? 1.0 : method_ == Method::both ? part_of_critical : 0.0);
  longest_epoch_ = kinetic && frequency_ > 0.0 ? epoch_phase / frequency_ : HUGE_VAL;
  // Where a single step is longer, the peak may be between two of them, and the nearer one counts: v.M a falls at the
  // rate omega^2 v.M v there. Epochs that end soon after a peak are better than such that end about it.
  const double half_step = times.dt > longest_epoch_ ? 0.5 * times.dt : 0.0;
  stops_ = kinetic && sums.power < half_step * frequency_ * frequency_ * sums.kinetic;
}

/// Goes on to the next method, and with more patience, when the one at hand has brought the residual no further down.
void Relaxation::choose(double time, bool loaded) {
  phase_ += frequency_ * (time - time_);
  if (!loaded || residual_ < progress * least_residual_) {
    least_residual_ = residual_;
    phase_ = 0.0;
  } else if (phase_ > patience_) {
    method_ = method_ == Method::both ? Method::kinetic : method_ == Method::kinetic ? Method::viscous : Method::both;
    least_residual_ = residual_;
    phase_ = 0.0;
    patience_ *= 2.0;
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
