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
#include "model/build_rigid.hpp"
#include "model/build_ties.hpp"
#include "model/build_walls.hpp"
#include "model/condition_lookup.hpp"
#include "model/element_shares.hpp"
#include "model/node_sets.hpp"
#include "model/topology.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

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

/// Gives the elements of rigid bodies whose mass is given the density for it, and takes all of them out of the search
/// for the smallest step, unless there are no others: then they stand for what the penalty stiffness of contact has to
/// go by.
void make_rigid(const Description& description, Model& model, ElementShares& shares) {
  const auto is_rigid = [&](const Body& body) { return description.bodies[at(body.description)].rigid; };
  const bool all_rigid = std::all_of(model.bodies.begin(), model.bodies.end(), is_rigid);
  for (Body& body : model.bodies) {
    if (!is_rigid(body)) {
      continue;
    }
    const double given = description.bodies[at(body.description)].mass;
    double sum = 0.0;
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      sum += 3.0 * shares.mass[at(e)];
    }
    body.density_factor = given > 0.0 ? given / sum : 1.0;
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      shares.mass[at(e)] *= body.density_factor;
      shares.inertia[at(e)] *= body.density_factor;
      shares.step[at(e)] = all_rigid ? std::sqrt(body.density_factor) * shares.step[at(e)] : HUGE_VAL;
    }
  }
}

/// Gives elements that need a smaller step than asked for as much mass as it takes: the step goes with its root. With
/// stiffness damping beta a step dt is critical for the undamped one sqrt(dt^2 + 2 beta dt).
void scale_masses(Model& model, ElementShares& shares) {
  if (model.run.minimum_step < 0.0) {
    return;
  }
  const double damped = model.run.minimum_step / model.run.safety;
  const double target = std::sqrt(damped * damped + 2.0 * model.run.stiffness_damping * damped);
  const auto is_short = [&](double step) { return step < target; };
  if (std::none_of(shares.step.begin(), shares.step.end(), is_short)) {
    return;
  }
  model.step_factor.assign(shares.step.size(), 1.0);
  for (std::size_t e = 0; e < shares.step.size(); ++e) {
    if (is_short(shares.step[e])) {
      const double factor = target / shares.step[e];
      model.step_factor[e] = factor;
      shares.mass[e] *= factor * factor;
      shares.inertia[e] *= factor * factor;
      shares.step[e] *= factor;
    }
  }
}

/// Lumped masses and inertias, areas and half thicknesses; each node gathers its own corners.
void build_masses(const Description& description, Model& model) {
  const std::size_t elements = model.triangle.size(), nodes = model.reference_position.size();
  ElementShares shares = element_shares(model);
  model.reference_area = std::move(shares.area);
  make_rigid(description, model, shares);
  scale_masses(model, shares);
  model.first_critical_step = HUGE_VAL;
  for (std::size_t e = 0; e < elements; ++e) {
    if (shares.step[e] < model.first_critical_step) {
      model.first_critical_step = shares.step[e];
      model.first_critical_element = static_cast<Index>(e);
    }
  }
  model.mass.resize(nodes);
  model.inertia.resize(nodes);
  model.half_thickness.resize(nodes);
  model.node_size.resize(nodes);
  parallel::for_each(model.node_count(), 1024, [&](Index n) {
    double mass = 0.0, inertia = 0.0, thickness = 0.0, area = HUGE_VAL;
    for (Index c = model.corner_start[at(n)]; c < model.corner_start[at(n) + 1]; ++c) {
      const Index e = model.corner[at(c)] / 3;
      mass += shares.mass[at(e)];
      inertia += shares.inertia[at(e)];
      thickness = std::max(thickness, model.section_of(e).thickness);
      area = std::min(area, model.reference_area[at(e)]);
    }
    model.mass[at(n)] = mass;
    model.inertia[at(n)] = inertia;
    model.half_thickness[at(n)] = 0.5 * thickness;
    model.node_size[at(n)] = std::sqrt(area);
  });
  for (const AddedNode& point : model.point_masses) {
    model.mass[at(point.node)] += point.mass;
    model.inertia[at(point.node)] += point.inertia;
  }
  for (Body& body : model.bodies) {
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      body.mass += model.mass[at(n)];
    }
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

/// Names the first node of each described body whose mass or penalty stiffness is no positive finite number.
void check_masses(const Description& description, const Model& model, ErrorList& errors) {
  Index reported = no_index;
  for (const Body& body : model.bodies) {
    for (Index n = body.nodes.begin; n < body.nodes.end && body.description != reported; ++n) {
      if (positive.contains(model.mass[at(n)]) && positive.contains(model.inertia[at(n)]) &&
          positive.contains(model.contact_stiffness[at(n)])) {
        continue;
      }
      const bool alone = model.corner_start[at(n)] == model.corner_start[at(n) + 1];
      errors.add(description.bodies[at(body.description)].place,
                 fmt::format("node {} of body \"{}\" {}", model.node_label[at(n)], body.name,
                             alone ? "belongs to no triangle"
                                   : fmt::format("has mass {:g} and penalty stiffness {:g}", model.mass[at(n)],
                                                 model.contact_stiffness[at(n)])),
                 "positive finite mass and stiffness at every node",
                 alone ? "remove the node from the mesh" : "correct scale, thickness, material or their units");
      reported = body.description;
    }
  }
}

}  // namespace

Model build_model(const Description& description, std::span<const Mesh> meshes, ErrorList& errors,
                  std::span<const Vec3d> positions) {
  assert(meshes.size() == description.bodies.size());
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
  build_masses(description, model);
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

}  // namespace fexp::model
