// SPDX-License-Identifier: Apache-2.0
#include "model/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "base/pack.hpp"
#include "model/build_bodies.hpp"
#include "model/build_checks.hpp"
#include "model/node_sets.hpp"
#include "model/topology.hpp"
#include "parallel/parallel.hpp"
#include "physics/critical_step.hpp"

namespace fexp::model {

namespace {

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

/// What elements bring to the nodes at their corners, and their critical steps, shape [elements] each.
struct ElementShares {
  explicit ElementShares(std::size_t elements) : mass(elements), inertia(elements), step(elements) {}

  std::vector<double> mass;     // Of one corner [mass]
  std::vector<double> inertia;  // Of one corner [mass*length^2]
  std::vector<double> step;     // [time]
};

/// The elements of one block side by side, as the roots of a critical step are found one after the other.
void share_block(const ElementBlock& block, Model& model, ElementShares& shares) {
  using Lanes = Pack<block_lanes>;
  Vec3<Lanes> side_12, side_13;
  for (Index lane = 0; lane < block_lanes; ++lane) {
    const Triangle& t = model.triangle[at(block.first + std::min(lane, block.count - 1))];
    const Vec3d& origin = model.reference_position[at(t[0])];
    const Vec3d a = model.reference_position[at(t[1])] - origin, b = model.reference_position[at(t[2])] - origin;
    side_12.x.set_lane(lane, a.x);
    side_12.y.set_lane(lane, a.y);
    side_12.z.set_lane(lane, a.z);
    side_13.x.set_lane(lane, b.x);
    side_13.y.set_lane(lane, b.y);
    side_13.z.set_lane(lane, b.z);
  }
  const auto frame = physics::triangle_frame(side_12, side_13);
  const SectionData& section = model.sections[at(block.section)];
  const Lanes step =
      physics::element_critical_step({section.thickness, section.moduli, model.run.drilling}, section.density, frame);
  for (Index lane = 0; lane < block.count; ++lane) {
    const std::size_t e = at(block.first + lane);
    const double area = 0.5 * frame.doubled_area.lane(lane);
    model.reference_area[e] = area;
    shares.mass[e] = physics::corner_mass(section.density, section.thickness, area);
    shares.inertia[e] = physics::corner_inertia(shares.mass[e], section.thickness, area);
    shares.step[e] = step.lane(lane);
  }
}

/// Lumped masses and inertias, areas, half thicknesses and penalty stiffnesses; each node gathers its own corners.
void build_masses(Model& model) {
  const std::size_t elements = model.triangle.size(), nodes = model.reference_position.size();
  ElementShares shares(elements);
  model.reference_area.resize(elements);
  parallel::for_each(model.block_count(), 1024 / block_lanes,
                     [&](Index block) { share_block(model.blocks[at(block)], model, shares); });
  model.first_critical_step = HUGE_VAL;
  for (std::size_t e = 0; e < elements; ++e) {
    if (shares.step[e] < model.first_critical_step) {
      model.first_critical_step = shares.step[e];
      model.first_critical_element = static_cast<Index>(e);
    }
  }
  const double frequency = penalty_courant / model.first_critical_step;
  model.mass.resize(nodes);
  model.inertia.resize(nodes);
  model.half_thickness.resize(nodes);
  model.node_size.resize(nodes);
  model.contact_stiffness.resize(nodes);
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
    model.contact_stiffness[at(n)] = model.contact.penalty_scale * mass * frequency * frequency;
  });
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
    Vec3d centre;
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      centre += (model.mass[at(n)] / body.mass) * model.reference_position[at(n)];
    }
    parallel::for_each(body.nodes.size(), 4096, [&](Index i) {
      const std::size_t n = at(body.nodes.begin + i);
      model.initial_velocity[n] = given.velocity + cross(given.angular_velocity, model.reference_position[n] - centre);
      model.initial_rotation_rate[n] = given.angular_velocity;
    });
  });
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

void build_exclusions(const Description& description, Model& model, ErrorList& errors) {
  const BodyNames names(model);
  const auto find = [&](const std::string& name) {
    return names.find(std::span(&name, 1), description.contact.place, "contact.exclude", errors);
  };
  for (const auto& [first, second] : description.contact.exclude) {
    const std::vector<Index> bodies = find(first);
    if (first == second) {  // Takes self-contact from each copy; copies still touch each other.
      for (const Index i : bodies) {
        model.excluded_pairs.emplace_back(i, i);
      }
      continue;
    }
    for (const Index j : find(second)) {
      for (const Index i : bodies) {
        model.excluded_pairs.emplace_back(std::min(i, j), std::max(i, j));
      }
    }
  }
  std::sort(model.excluded_pairs.begin(), model.excluded_pairs.end());
  model.excluded_pairs.erase(std::unique(model.excluded_pairs.begin(), model.excluded_pairs.end()),
                             model.excluded_pairs.end());
}

}  // namespace

Model build_model(const Description& description, std::span<const Mesh> meshes, ErrorList& errors) {
  assert(meshes.size() == description.bodies.size());
  Model model;
  check_description(description, errors);
  model.run = description.run;
  model.contact = description.contact;
  model.curves = description.curves;
  model.planes = description.planes;
  for (RigidPlane& plane : model.planes) {
    plane.normal = (1.0 / norm(plane.normal)) * plane.normal;
  }
  build_sections(description, model);
  build_bodies(description, meshes, model, errors);
  if (!errors.empty()) {
    return model;
  }
  place_layers(model);
  CornerRows rows = corner_rows(model.node_count(), model.triangle);
  model.corner_start = std::move(rows.start);
  model.corner = std::move(rows.corner);
  build_masses(model);
  check_masses(description, model, errors);
  build_velocities(description, model);
  build_exclusions(description, model, errors);
  build_conditions(description, meshes, model, errors);
  return model;
}

}  // namespace fexp::model
