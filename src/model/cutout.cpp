// SPDX-License-Identifier: Apache-2.0
#include "model/cutout.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace fexp::model {

namespace {

/// Sum over the corners.
Vec3d corner_sum(const Model& model, const State& state, Index element) {
  Vec3d sum;
  for (const Index n : model.triangle[at(element)]) {
    sum += state.motion[at(n)].position;
  }
  return sum;
}

template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<Index>& which) {
  std::vector<T> result;
  result.reserve(which.size());
  for (const Index i : which) {
    result.push_back(values[at(i)]);
  }
  return result;
}

}  // namespace

Cutout neighbourhood(const Model& model, const State& state, Index element, Index most) {
  const Vec3d centre = corner_sum(model, state, element);
  std::vector<std::pair<double, Index>> near;
  near.reserve(at(model.element_count()));
  for (Index e = 0; e < model.element_count(); ++e) {
    const Vec3d way = corner_sum(model, state, e) - centre;
    const double distance2 = dot(way, way);
    // The element itself first, what is nowhere last.
    near.emplace_back(e == element ? -1.0 : std::isnan(distance2) ? HUGE_VAL : distance2, e);
  }
  const auto end = near.begin() + std::min(most, model.element_count());
  std::partial_sort(near.begin(), end, near.end());
  near.erase(end, near.end());
  Cutout cutout;
  std::unordered_map<Index, Index> place;
  for (const auto& [distance2, e] : near) {
    cutout.elements.push_back(e);
    std::array<Index, 3>& triangle = cutout.triangle.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      const Index node = model.triangle[at(e)][a];
      const auto [found, is_new] = place.try_emplace(node, static_cast<Index>(cutout.nodes.size()));
      if (is_new) {
        cutout.nodes.push_back(node);
      }
      triangle[a] = found->second;
    }
  }
  cutout.node_body = picked(model.node_body, cutout.nodes);
  cutout.node_label = picked(model.node_label, cutout.nodes);
  cutout.element_label = picked(model.element_label, cutout.elements);
  return cutout;
}

Frame cut_out(const Frame& frame, const Cutout& cutout) {
  const auto at_nodes = [&](const auto& values) { return picked(values, cutout.nodes); };
  const auto at_elements = [&](const auto& values) { return picked(values, cutout.elements); };
  Frame cut;
  cut.step = frame.step;
  cut.time = frame.time;
  cut.position = at_nodes(frame.position);
  cut.displacement = at_nodes(frame.displacement);
  cut.velocity = at_nodes(frame.velocity);
  cut.rotation_rate = at_nodes(frame.rotation_rate);
  cut.contact_force = at_nodes(frame.contact_force);
  cut.tie_force = at_nodes(frame.tie_force);
  cut.tied = at_nodes(frame.tied);
  cut.membrane_force = at_elements(frame.membrane_force);
  cut.bending_moment = at_elements(frame.bending_moment);
  cut.shear_force = at_elements(frame.shear_force);
  cut.von_mises_top = at_elements(frame.von_mises_top);
  cut.von_mises_bottom = at_elements(frame.von_mises_bottom);
  cut.energy_density = at_elements(frame.energy_density);
  cut.thickness = at_elements(frame.thickness);
  cut.plastic_strain = at_elements(frame.plastic_strain);
  cut.temperature = at_elements(frame.temperature);
  cut.deleted = at_elements(frame.deleted);
  cut.body = at_elements(frame.body);
  cut.island = at_elements(frame.island);
  return cut;
}

}  // namespace fexp::model
