// SPDX-License-Identifier: Apache-2.0
#include "model/capture.hpp"

#include <algorithm>

#include "model/element_stresses.hpp"
#include "model/tie_forces.hpp"
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
  frame.tie_force.assign(count, {});
  frame.tied.assign(count, 0);
  parallel::for_each(static_cast<Index>(state.ties.size()), grain, [&](Index tie) {
    const std::size_t n = at(model.ties.ties[at(tie)].node);
    frame.tie_force[n] = single(tie_force(model, state, state.time, tie).force);
    frame.tied[n] = state.ties[at(tie)].broken == 0 ? 1 : 0;
  });
}

template <std::size_t N>
std::array<float, N> single(const std::array<double, N>& values) noexcept {
  std::array<float, N> result{};
  std::transform(values.begin(), values.end(), result.begin(), [](double v) { return static_cast<float>(v); });
  return result;
}

void capture_element(const Model& model, const State& state, Index element, Frame& frame) {
  const std::size_t e = at(element);
  const ElementStresses stresses = element_stresses(model, state, element);
  const auto& [top_xx, top_yy, top_xy] = stresses.top;
  const auto& [bottom_xx, bottom_yy, bottom_xy] = stresses.bottom;
  frame.membrane_force[e] = single(stresses.membrane_force);
  frame.bending_moment[e] = single(stresses.bending_moment);
  frame.shear_force[e] = single(stresses.shear_force);
  frame.von_mises_top[e] = static_cast<float>(von_mises(top_xx, top_yy, top_xy));
  frame.von_mises_bottom[e] = static_cast<float>(von_mises(bottom_xx, bottom_yy, bottom_xy));
  const double volume = model.reference_area[e] * model.section_of(element).thickness;
  frame.energy_density[e] = static_cast<float>(element_value(model, state, element, row_energy) / volume);
  frame.thickness[e] = static_cast<float>(stresses.thickness);
  frame.plastic_strain[e] = static_cast<float>(stresses.plastic_strain);
  frame.temperature[e] = static_cast<float>(stresses.temperature);
  frame.deleted[e] = stresses.deleted ? 1 : 0;
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
  frame.temperature.resize(count);
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
