// SPDX-License-Identifier: Apache-2.0
#include "model/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "model/branches.hpp"
#include "model/build_bodies.hpp"
#include "model/build_checks.hpp"
#include "model/build_contact.hpp"
#include "model/build_masses.hpp"
#include "model/build_rigid.hpp"
#include "model/build_ties.hpp"
#include "model/build_walls.hpp"
#include "model/condition_lookup.hpp"
#include "model/node_sets.hpp"
#include "model/topology.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

/// Builds until elements at ties get the largest mass that they may need.
constexpr int most_tries = 6;

void build_curve_areas(Model& model) {
  for (const Curve& curve : model.curves) {
    std::vector<double>& areas = model.curve_areas.emplace_back();
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const auto& [time, value] = curve.points[i];
      areas.push_back(i == 0 ? 0.0
                             : areas.back() + 0.5 * (time - curve.points[i - 1][0]) * (value + curve.points[i - 1][1]));
    }
  }
}

void build_sections(const Description& description, Model& model) {
  for (const Section& section : description.sections) {
    SectionData data;
    data.name = section.name;
    data.thickness = section.thickness;
    for (const Material& material : description.materials) {
      if (material.name == section.material) {
        data.law = material.law;
        std::visit(
            [&](const auto& law) {
              data.moduli = law.moduli();
              data.density = law.density;
              if constexpr (requires { law.plasticity(); }) {
                const auto rule = section.quadrature == quadrature_names[0] ? physics::Quadrature::gauss
                                                                            : physics::Quadrature::lobatto;
                data.layered = {physics::through_thickness(rule, section.points), data.moduli,
                                physics::J2Elasticity::of(data.moduli), law.plasticity()};
              }
            },
            material.law);
      }
    }
    model.plastic = model.plastic || data.layered.points.count > 0;
    model.can_fail = model.can_fail || data.layered.plasticity.can_fail();
    model.sections.push_back(std::move(data));
  }
}

/// Gives every block of a layered section its rows of State::layers.
void place_layers(Model& model) {
  Index row = 0;
  for (ElementBlock& block : model.blocks) {
    const Index rows = model.sections[at(block.section)].layer_rows();
    block.layer_row = rows > 0 ? row : no_index;
    row += rows;
  }
}

void build_velocities(const Description& description, Model& model) {
  model.initial_velocity.resize(model.reference_position.size());
  model.initial_rotation_rate.resize(model.reference_position.size());
  parallel::for_each(model.body_count(), 1, [&](Index index) {
    const Body& body = model.bodies[at(index)];
    const BodyDescription& given = description.bodies[at(body.description)];
    const Vec3d centre = centre_of_mass(model, body);
    parallel::for_each(body.nodes.size(), 4096, [&](Index i) {
      const std::size_t n = at(body.nodes.begin + i);
      model.initial_velocity[n] = given.velocity + cross(given.angular_velocity, model.reference_position[n] - centre);
      model.initial_rotation_rate[n] = given.angular_velocity;
    });
  });
}

/// Adds the velocities of node sets.
void add_velocities(const Description& description, Model& model, ErrorList& errors) {
  for (const InitialVelocity& given : description.initial_velocities) {
    const Vec3d axis = (1.0 / norm(given.axis)) * given.axis;
    for (const Index n : Lookup(model).nodes(given.set)) {
      const Body& body = model.bodies[at(model.node_body[at(n)])];
      if (description.bodies[at(body.description)].rigid) {
        errors.add(
            given.place,
            fmt::format("velocity of set \"{}\": it has nodes of body \"{}\", which is rigid", given.set, body.name),
            "no nodes of rigid bodies", "give the velocity in the [[body]]");
        break;
      }
      const Vec3d from_point = model.reference_position[at(n)] - given.point;
      const Vec3d from_axis = from_point - dot(from_point, axis) * axis;
      const double distance = norm(from_axis);
      if (given.radial != 0.0 && !(distance > 0.0)) {
        errors.add(given.place,
                   fmt::format("radial velocity of set \"{}\": node {} of body \"{}\" lies on the axis", given.set,
                               model.node_label[at(n)], model.bodies[at(model.node_body[at(n)])].name),
                   "nodes beside the axis", "take the node out of the set, or correct axis and point");
        break;
      }
      model.initial_velocity[at(n)] += given.velocity;
      if (given.radial != 0.0) {
        model.initial_velocity[at(n)] += (given.radial / distance) * from_axis;
      }
    }
  }
}

/// `ratio`: by what ties raise omega^2, see build_masses.
Model build_once(const Description& description, std::span<const Mesh> meshes, ErrorList& errors,
                 std::span<const Vec3d> positions, std::span<const double> ratio) {
  Model model;
  check_description(description, errors);
  model.run = description.run;
  model.contact = description.contact;
  model.curves = description.curves;
  build_curve_areas(model);
  build_walls(description, model);
  build_sections(description, model);
  const BuiltBodies built = build_bodies(description, meshes, model, errors);
  if (!errors.empty()) {
    return model;
  }
  place_layers(model);
  CornerRows rows = corner_rows(model.node_count(), model.triangle);
  model.corner_start = std::move(rows.start);
  model.corner = std::move(rows.corner);
  if (built.branched) {
    model.next_at_edge = edge_rounds(model.triangle);
    model.corner_fan = corner_fans(model.triangle, model.neighbour);
  }
  build_node_sets(description, built.groups, model, errors);
  if (!positions.empty()) {
    // Those of rigid walls with mass come last, and have no nodes here yet.
    std::copy_n(positions.begin(), model.reference_position.size(), model.reference_position.begin());
  }
  build_point_masses(description, model);
  build_masses(description, model, ratio);
  build_contact_stiffness(model);
  check_masses(description, model, errors);
  build_velocities(description, model);
  add_velocities(description, model, errors);
  build_rigid_bodies(description, model);
  build_contact_pairs(description, model, errors);
  build_conditions(description, meshes, model, errors);
  build_ties(description, model, errors);
  find_body_ranges(model);
  build_wall_bodies(description, model);
  return model;
}

}  // namespace

Model build_model(const Description& description, std::span<const Mesh> meshes, ErrorList& errors,
                  std::span<const Vec3d> positions) {
  assert(meshes.size() == description.bodies.size());
  std::vector<double> ratio;
  Model model = build_once(description, meshes, errors, positions, ratio);
  // Mass that elements get changes what ties make of the step, and the other way round.
  for (int tries = 1; errors.empty() && raise_ratios(model, tries >= most_tries, ratio); ++tries) {
    model = build_once(description, meshes, errors, positions, ratio);
  }
  return model;
}

}  // namespace fexp::model
