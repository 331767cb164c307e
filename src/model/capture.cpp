// SPDX-License-Identifier: Apache-2.0
#include "model/capture.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

constexpr Index grain = 4096;

std::array<float, 3> single(const Vec3d& v) noexcept {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

void capture_nodes(const Model& model, const State& state, std::span<const Vec3d> contact_force, Frame& frame) {
  const std::size_t count = model.reference_position.size();
  frame.position.resize(count);
  frame.displacement.resize(count);
  frame.velocity.resize(count);
  frame.rotation_rate.resize(count);
  frame.contact_force.resize(count);
  parallel::for_each(model.node_count(), grain, [&](Index node) {
    const std::size_t n = at(node);
    const NodeMotion& motion = state.motion[n];
    frame.position[n] = motion.position;
    frame.displacement[n] = single(motion.position - model.reference_position[n]);
    frame.velocity[n] = single(motion.velocity);
    frame.rotation_rate[n] = single(motion.rotation_rate);
    frame.contact_force[n] = contact_force.empty() ? std::array<float, 3>{} : single(contact_force[n]);
  });
}

/// What points through the thickness know better than the resultants.
void capture_layers(const Model& model, const State& state, Index element, Frame& frame) {
  const std::size_t e = at(element);
  const auto row = [&](Index r) { return layer_value(model, state, element, r); };
  const auto stress_at = [&](Index point) {
    const Index first = physics::layer_points + point * physics::point_rows;
    const double mean = 0.5 * row(first + physics::point_sum), half = 0.5 * row(first + physics::point_difference);
    return static_cast<float>(von_mises(mean + half, mean - half, row(first + physics::point_shear)));
  };
  const Index points = model.section_of(element).layered.points.count;
  double strain = 0.0;
  for (Index p = 0; p < points; ++p) {
    strain = std::max(strain, row(physics::layer_points + p * physics::point_rows + physics::point_strain));
  }
  frame.von_mises_top[e] = stress_at(points - 1);
  frame.von_mises_bottom[e] = stress_at(0);
  frame.thickness[e] = static_cast<float>(row(physics::layer_thickness));
  frame.plastic_strain[e] = static_cast<float>(strain);
  frame.deleted[e] = is_deleted(model, state.layers.data(), element) ? 1 : 0;
}

void capture_element(const Model& model, const State& state, Index element, Frame& frame) {
  const std::size_t e = at(element);
  const auto row = [&](ElementRow r) { return element_value(model, state, element, r); };
  const double t = model.section_of(element).thickness;
  const std::array<double, 3> n{row(row_nxx), row(row_nyy), row(row_nxy)};
  const std::array<double, 3> m{row(row_mxx), row(row_myy), row(row_mxy)};
  std::array<double, 3> top{};
  std::array<double, 3> bottom{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double membrane = n[i] / t;
    const double bending = 6.0 * m[i] / (t * t);
    top[i] = membrane + bending;
    bottom[i] = membrane - bending;
    frame.membrane_force[e][i] = static_cast<float>(n[i]);
    frame.bending_moment[e][i] = static_cast<float>(m[i]);
  }
  frame.shear_force[e] = {static_cast<float>(row(row_qxz)), static_cast<float>(row(row_qyz))};
  frame.von_mises_top[e] = static_cast<float>(von_mises(top[0], top[1], top[2]));
  frame.von_mises_bottom[e] = static_cast<float>(von_mises(bottom[0], bottom[1], bottom[2]));
  frame.energy_density[e] = static_cast<float>(row(row_energy) / (model.reference_area[e] * t));
  frame.thickness[e] = static_cast<float>(t);
  frame.plastic_strain[e] = 0.0F;
  frame.deleted[e] = 0;
  if (model.blocks[at(model.element_block[e])].layer_row != no_index) {
    capture_layers(model, state, element, frame);
  }
}

void capture_elements(const Model& model, const State& state, std::span<const Index> island_of_body, Frame& frame) {
  const std::size_t count = model.triangle.size();
  frame.membrane_force.resize(count);
  frame.bending_moment.resize(count);
  frame.shear_force.resize(count);
  frame.von_mises_top.resize(count);
  frame.von_mises_bottom.resize(count);
  frame.energy_density.resize(count);
  frame.thickness.resize(count);
  frame.plastic_strain.resize(count);
  frame.deleted.resize(count);
  frame.body.resize(count);
  frame.island.resize(count);
  parallel::for_each(model.element_count(), grain, [&](Index element) {
    capture_element(model, state, element, frame);
    const Index body = model.blocks[at(model.element_block[at(element)])].body;
    frame.body[at(element)] = body;
    frame.island[at(element)] = island_of_body.empty() ? no_index : island_of_body[at(body)];
  });
}

}  // namespace

double von_mises(double sxx, double syy, double sxy) noexcept {
  return std::sqrt(sxx * sxx - sxx * syy + syy * syy + 3.0 * sxy * sxy);
}

void capture_into(const Model& model, const State& state, std::span<const Vec3d> contact_force,
                  std::span<const Index> island_of_body, Frame& frame) {
  frame.step = state.step;
  frame.time = state.time;
  capture_nodes(model, state, contact_force, frame);
  capture_elements(model, state, island_of_body, frame);
}

Frame capture(const Model& model, const State& state, std::span<const Vec3d> contact_force,
              std::span<const Index> island_of_body) {
  Frame frame;
  capture_into(model, state, contact_force, island_of_body, frame);
  return frame;
}

}  // namespace fexp::model
