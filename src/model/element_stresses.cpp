// SPDX-License-Identifier: Apache-2.0
#include "model/element_stresses.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::model {

namespace {

/// What points through the thickness know better than the resultants.
void take_layers(const Model& model, const State& state, Index element, ElementStresses& stresses) {
  const auto row = [&](Index r) { return layer_value(model, state, element, r); };
  const auto stress_at = [&](Index point) {
    const Index first = physics::layer_points + point * physics::point_rows;
    const double mean = 0.5 * row(first + physics::point_sum), half = 0.5 * row(first + physics::point_difference);
    return std::array{mean + half, mean - half, row(first + physics::point_shear)};
  };
  const physics::LayeredSection& section = model.section_of(element).layered;
  const Index points = section.points.count;
  for (Index p = 0; p < points; ++p) {
    stresses.plastic_strain =
        std::max(stresses.plastic_strain, row(physics::layer_points + p * physics::point_rows + physics::point_strain));
  }
  if (section.plasticity.heat.heats()) {
    stresses.temperature = row(section.temperature_row(0));
    for (Index p = 1; p < points; ++p) {
      stresses.temperature = std::max(stresses.temperature, row(section.temperature_row(p)));
    }
  }
  stresses.top = stress_at(points - 1);
  stresses.bottom = stress_at(0);
  stresses.thickness = row(physics::layer_thickness);
  stresses.deleted = is_deleted(model, state.layers.data(), element);
}

}  // namespace

ElementStresses element_stresses(const Model& model, const State& state, Index element) {
  const auto row = [&](ElementRow r) { return element_value(model, state, element, r); };
  ElementStresses stresses;
  stresses.membrane_force = {row(row_nxx), row(row_nyy), row(row_nxy)};
  stresses.bending_moment = {row(row_mxx), row(row_myy), row(row_mxy)};
  stresses.shear_force = {row(row_qxz), row(row_qyz)};
  stresses.thickness = model.section_of(element).thickness;
  if (model.blocks[at(model.element_block[at(element)])].layer_row != no_index) {
    take_layers(model, state, element, stresses);
    return stresses;
  }
  const double t = stresses.thickness;
  for (std::size_t i = 0; i < 3; ++i) {
    const double membrane = stresses.membrane_force[i] / t, bending = 6.0 * stresses.bending_moment[i] / (t * t);
    stresses.top[i] = membrane + bending;
    stresses.bottom[i] = membrane - bending;
  }
  return stresses;
}

double von_mises(double sxx, double syy, double sxy) noexcept {
  return std::sqrt(sxx * sxx - sxx * syy + syy * syy + 3.0 * sxy * sxy);
}

}  // namespace fexp::model
