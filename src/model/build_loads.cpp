// SPDX-License-Identifier: Apache-2.0
#include "model/build_loads.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/build_bodies.hpp"
#include "model/build_checks.hpp"
#include "model/node_sets.hpp"

namespace fexp::model {

void build_node_sets(const Description& description, std::span<const std::vector<NodeGroup>> groups, Model& model,
                     ErrorList& errors) {
  NamedNodes all{"all", {}};
  for (Index n = 0; n < model.node_count(); ++n) {
    all.nodes.push_back(n);
  }
  model.node_sets.push_back(std::move(all));
  const BodyNames names(model);
  for (const NodeSet& set : description.node_sets) {
    model.node_sets.push_back({set.name, select_nodes(set, groups, model, names, errors)});
  }
}

void build_point_masses(const Description& description, Model& model) {
  const Lookup lookup(model);
  for (const PointMass& point : description.point_masses) {
    const std::vector<Index>& nodes = lookup.nodes(point.set);
    const double share = point.total && !nodes.empty() ? 1.0 / static_cast<double>(nodes.size()) : 1.0;
    for (const Index n : nodes) {
      model.point_masses.push_back({n, share * point.mass, share * point.inertia});
    }
  }
  std::stable_sort(model.point_masses.begin(), model.point_masses.end(),
                   [](const AddedNode& a, const AddedNode& b) { return a.node < b.node; });
}

void build_loads(const Description& description, const Lookup& lookup, Model& model) {
  for (const Gravity& gravity : description.gravity) {
    model.gravity.push_back({gravity.acceleration, lookup.curve(gravity.curve)});
  }
  for (const NodalForce& force : description.forces) {
    const std::vector<Index>& nodes = lookup.nodes(force.set);
    const double share = force.total && !nodes.empty() ? 1.0 / static_cast<double>(nodes.size()) : 1.0;
    const Index curve = lookup.curve(force.curve);
    for (const Index n : nodes) {
      model.forces.push_back({n, share * force.force, share * force.moment, curve});
    }
  }
  std::stable_sort(model.forces.begin(), model.forces.end(),
                   [](const NodeLoad& a, const NodeLoad& b) { return a.node < b.node; });
}

void build_pressure(const Description& description, std::span<const Mesh> meshes, const Lookup& lookup, Model& model,
                    ErrorList& errors) {
  const BodyNames names(model);
  for (const Pressure& pressure : description.pressure) {
    const Index curve = lookup.curve(pressure.curve);
    const std::size_t before = model.pressure.size(), errors_before = errors.size();
    std::vector<std::string> known;
    for (const Index b : names.find(pressure.bodies, pressure.place, "a pressure", errors)) {
      const Body& body = model.bodies[at(b)];
      const std::vector<std::string>& parts = meshes[at(body.description)].part_names;
      Index part = no_index;
      for (std::size_t p = 0; p < parts.size(); ++p) {
        part = parts[p] == pressure.part ? static_cast<Index>(p) : part;
        if (std::find(known.begin(), known.end(), parts[p]) == known.end()) {
          known.push_back(parts[p]);
        }
      }
      for (Index e = body.elements.begin; e < body.elements.end; ++e) {
        if (pressure.part.empty() || model.element_part[at(e)] == part) {
          model.pressure.push_back({e, pressure.value, curve});
        }
      }
    }
    if (model.pressure.size() == before && errors.size() == errors_before) {
      errors.add(pressure.place,
                 pressure.bodies.empty()
                     ? "a pressure names no body"
                     : fmt::format("a pressure loads no face: there is no part \"{}\"", pressure.part),
                 name_list(pressure.bodies.empty() ? names.families() : known),
                 pressure.bodies.empty() ? "name the bodies it loads" : "correct the part or the bodies");
    }
  }
  std::stable_sort(model.pressure.begin(), model.pressure.end(),
                   [](const PressureLoad& a, const PressureLoad& b) { return a.element < b.element; });
}

}  // namespace fexp::model
