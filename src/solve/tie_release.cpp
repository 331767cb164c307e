// SPDX-License-Identifier: Apache-2.0
#include "solve/tie_release.hpp"

#include <array>

#include "model/tie_motion.hpp"

namespace fexp::solve {

namespace {

/// A node and its carriers, as far as these have a weight.
struct Cluster {
  std::array<Index, 4> node{};
  std::size_t count{};
  double mass{};
  Vec3d centre;
};

Cluster cluster_of(const model::Tie& tie, const model::State& state) {
  Cluster cluster;
  cluster.node[cluster.count++] = tie.node;
  for (std::size_t a = 0; a < 3; ++a) {
    if (tie.weight[a] > 0.0) {
      cluster.node[cluster.count++] = tie.carrier[a];
    }
  }
  for (std::size_t i = 0; i < cluster.count; ++i) {
    const double mass = state.moving[at(cluster.node[i])].mass;
    cluster.mass += mass;
    cluster.centre += mass * state.motion[at(cluster.node[i])].position;
  }
  cluster.centre = (1.0 / cluster.mass) * cluster.centre;
  return cluster;
}

/// J^-1 times a moment, J the inertia of the cluster about its centre, by its adjugate. Inertias of nodes keep J from
/// being singular.
Vec3d inverse_inertia_times(const Cluster& cluster, const model::State& state, const Vec3d& moment) {
  Vec3d row_x, row_y, row_z;
  for (std::size_t i = 0; i < cluster.count; ++i) {
    const model::NodeInertia& moving = state.moving[at(cluster.node[i])];
    const Vec3d d = state.motion[at(cluster.node[i])].position - cluster.centre;
    const double diagonal = moving.inertia + moving.mass * dot(d, d);
    row_x += Vec3d{diagonal, 0.0, 0.0} - (moving.mass * d.x) * d;
    row_y += Vec3d{0.0, diagonal, 0.0} - (moving.mass * d.y) * d;
    row_z += Vec3d{0.0, 0.0, diagonal} - (moving.mass * d.z) * d;
  }
  const Vec3d first = cross(row_y, row_z), second = cross(row_z, row_x), third = cross(row_x, row_y);
  return (1.0 / dot(row_x, first)) * (moment.x * first + moment.y * second + moment.z * third);
}

}  // namespace

Release release_tied_node(const model::Model& model, const model::Tie& tie, model::State& state) {
  const double mass = model.mass[at(tie.node)];
  state.moving[at(tie.node)] = {mass, model.inertia[at(tie.node)]};
  if (tie.held) {
    return {};
  }
  model::for_each_handed(model, tie, [&](Index carrier, double handed_mass, double handed_inertia) {
    state.moving[at(carrier)].mass -= handed_mass;
    state.moving[at(carrier)].inertia -= handed_inertia;
  });
  const model::TieRates rates = model::rates_at_carriers(tie, state);
  const Vec3d arm = model::arm_of(tie, state);
  model::rate_tied_node(tie, state);
  const Vec3d gained = mass * cross(rates.rotation_rate, arm);
  Vec3d point;
  for (std::size_t a = 0; a < 3; ++a) {
    point += tie.weight[a] * state.motion[at(tie.carrier[a])].position;
  }
  // The mass turned with the carriers about their point, and across its arm with their inertia.
  Vec3d lost = (mass * dot(arm, rates.rotation_rate)) * arm;
  for (std::size_t a = 0; a < 3; ++a) {
    const model::NodeMotion& carrier = state.motion[at(tie.carrier[a])];
    lost += (tie.weight[a] * mass) * cross(carrier.position - point, carrier.velocity - rates.velocity);
  }
  const Vec3d moved = mass * cross(arm, rates.velocity);
  if (tie.conditions) {
    return {gained, moved + cross(point, gained) - lost};
  }
  const Cluster cluster = cluster_of(tie, state);
  const Vec3d moment = lost - cross(point - cluster.centre, gained);
  const Vec3d velocity = (-1.0 / cluster.mass) * gained, rate = inverse_inertia_times(cluster, state, moment);
  for (std::size_t i = 0; i < cluster.count; ++i) {
    model::NodeMotion& node = state.motion[at(cluster.node[i])];
    node.velocity += velocity + cross(rate, node.position - cluster.centre);
    node.rotation_rate += rate;
  }
  return {{}, moved};
}

}  // namespace fexp::solve
