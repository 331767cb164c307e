// SPDX-License-Identifier: Apache-2.0
#include "model/build_rigid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/body_properties.hpp"
#include "model/held_directions.hpp"
#include "model/principal_axes.hpp"
#include "model/rigid_motion.hpp"

namespace fexp::model {

namespace {

using Symmetric = std::array<double, 6>;  // xx yy zz xy yz zx

double product(const Vec3d& a, const Symmetric& matrix, const Vec3d& b) {
  const auto& [xx, yy, zz, xy, yz, zx] = matrix;
  return dot(a, Vec3d{xx * b.x + xy * b.y + zx * b.z, xy * b.x + yy * b.y + yz * b.z, zx * b.x + yz * b.y + zz * b.z});
}

/// Inertia about a point of a unit mass that is `r` away.
Symmetric point_inertia(const Vec3d& r) {
  const double square = dot(r, r);
  return {square - r.x * r.x, square - r.y * r.y, square - r.z * r.z, -r.x * r.y, -r.y * r.z, -r.z * r.x};
}

void add_part(double scale, const Symmetric& part, Symmetric& sum) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += scale * part[i];
  }
}

/// Inertia that the masses of the nodes alone have about the centre, with that of point masses.
Symmetric lumped_inertia(const Model& model, const Body& body, const Vec3d& centre) {
  Symmetric sum{};
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    const Vec3d r = model.reference_position[at(n)] - centre;
    add_part(model.mass[at(n)], point_inertia(r), sum);
  }
  for (const AddedNode& point : model.point_masses) {
    for (std::size_t i = 0; i < 3 && body.nodes.contains(point.node); ++i) {
      sum[i] += point.inertia;
    }
  }
  return sum;
}

/// The largest eigenvalue of J^-1 times the inertia of the lumped masses, at least 1.
double inertia_ratio(const RigidBody& rigid, const Symmetric& lumped) {
  std::array<Vec3d, 3> scaled{};
  for (std::size_t i = 0; i < 3; ++i) {
    scaled[i] = (1.0 / std::sqrt(rigid.inertia[i])) * rigid.axis[i];
  }
  const auto entry = [&](std::size_t i, std::size_t j) { return product(scaled[i], lumped, scaled[j]); };
  const PrincipalAxes ratios =
      principal_axes({entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)});
  return std::max(1.0, ratios.value[2]);
}

RigidBody rigid_body(const Description& description, const Model& model, Index index) {
  const Body& body = model.bodies[at(index)];
  RigidBody rigid;
  rigid.body = index;
  rigid.mass = body.mass;
  rigid.centre = centre_of_mass(model, body);
  const PrincipalAxes axes = principal_axes(body_properties(model, index).inertia);
  rigid.inertia = axes.value;
  rigid.axis = axes.axis;
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    rigid.radius = std::max(rigid.radius, norm(model.reference_position[at(n)] - rigid.centre));
  }
  rigid.inertia_ratio = inertia_ratio(rigid, lumped_inertia(model, body, rigid.centre));
  const BodyDescription& given = description.bodies[at(body.description)];
  rigid.initial_velocity = given.velocity;
  rigid.initial_rotation_rate = given.angular_velocity;
  return rigid;
}

/// Nodes of an ascending list that are the body's.
std::size_t count_in(const std::vector<Index>& nodes, const Body& body) {
  return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), body.nodes.end) -
                                  std::lower_bound(nodes.begin(), nodes.end(), body.nodes.begin));
}

/// A set that a condition names has all nodes of a rigid body or none.
void check_set(const std::string& set, std::string_view condition, const Place& place, const Lookup& lookup,
               const Model& model, ErrorList& errors) {
  const std::vector<Index>& nodes = lookup.nodes(set);
  for (const RigidBody& rigid : model.rigid_bodies) {
    const Body& body = model.bodies[at(rigid.body)];
    const std::size_t count = count_in(nodes, body);
    if (count > 0 && count < at(body.nodes.size())) {
      errors.add(place,
                 fmt::format("set \"{}\" has {} of the {} nodes of body \"{}\", which is rigid and {} as a whole", set,
                             count, body.nodes.size(), body.name, condition),
                 "all nodes of a rigid body, or none of them", "choose the whole body, or leave it out of the set");
      return;
    }
  }
}

/// Conditions of all nodes of a body are those of its first one.
void take_conditions(const Model& model, RigidBody& rigid) {
  const Index node = model.bodies[at(rigid.body)].nodes.begin;
  const std::array<Vec3d, 3> axes = unit_axes({});
  for_each_at(model.fixed, node, [&](const FixedNode& fixed) {
    for (unsigned dof = 0; dof < 6; ++dof) {
      if ((fixed.mask >> dof & 1U) != 0) {
        (dof < 3 ? rigid.held : rigid.held_rotations).push_back(axes[dof % 3]);
      }
    }
  });
  for_each_at(model.oblique, node, [&](const ObliqueNode& oblique) {
    (oblique.angular ? rigid.held_rotations : rigid.held).push_back(oblique.direction);
  });
  for_each_at(model.prescribed, node, [&](const PrescribedNode& prescribed) {
    rigid.prescribed.push_back(prescribed);
    rigid.prescribes_rotation = rigid.prescribes_rotation || prescribed.angular();
  });
  rigid.turns_freely = rigid.held_rotations.empty() && !rigid.prescribes_rotation;
  rigid.initial_velocity = without(rigid.held, rigid.initial_velocity);
  rigid.initial_rotation_rate = without(rigid.held_rotations, rigid.initial_rotation_rate);
}

/// Takes the conditions of rigid bodies that move out of a list of nodes.
template <class Item>
void erase_moving(const Model& model, std::vector<Item>& items) {
  std::erase_if(items, [&](const Item& item) {
    const Body& body = model.bodies[at(model.node_body[at(item.node)])];
    return body.rigid != no_index && !body.barrier;
  });
}

}  // namespace

void build_rigid_bodies(const Description& description, Model& model) {
  for (Index b = 0; b < model.body_count(); ++b) {
    if (description.bodies[at(model.bodies[at(b)].description)].rigid) {
      model.bodies[at(b)].rigid = static_cast<Index>(model.rigid_bodies.size());
      model.rigid_bodies.push_back(rigid_body(description, model, b));
    }
  }
}

void add_tied_masses(Model& model) {
  for (RigidBody& rigid : model.rigid_bodies) {
    const auto number = model.bodies[at(rigid.body)].rigid;
    double mass = rigid.mass;
    Vec3d moment = rigid.mass * rigid.centre;
    for (const Tie& tie : model.ties.ties) {
      if (tie.rigid == number) {
        mass += model.mass[at(tie.node)];
        moment += model.mass[at(tie.node)] * model.reference_position[at(tie.node)];
      }
    }
    if (!(mass > rigid.mass)) {
      continue;
    }
    const Vec3d centre = (1.0 / mass) * moment;
    Symmetric sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& a = rigid.axis[i];
      add_part(rigid.inertia[i], {a.x * a.x, a.y * a.y, a.z * a.z, a.x * a.y, a.y * a.z, a.z * a.x}, sum);
    }
    add_part(rigid.mass, point_inertia(rigid.centre - centre), sum);
    for (const Tie& tie : model.ties.ties) {
      if (tie.rigid == number) {
        const Vec3d arm = model.reference_position[at(tie.node)] - centre;
        const double inertia = tie.rotations ? model.inertia[at(tie.node)] : 0.0;
        add_part(model.mass[at(tie.node)], point_inertia(arm), sum);
        add_part(inertia, {1.0, 1.0, 1.0, 0.0, 0.0, 0.0}, sum);
        rigid.radius = std::max(rigid.radius, norm(arm));
      }
    }
    const PrincipalAxes axes = principal_axes(sum);
    rigid.initial_velocity =
        without(rigid.held, rigid.initial_velocity + cross(rigid.initial_rotation_rate, centre - rigid.centre));
    rigid.radius += norm(centre - rigid.centre);
    rigid.mass = mass;
    rigid.centre = centre;
    rigid.inertia = axes.value;
    rigid.axis = axes.axis;
  }
}

void build_rigid_conditions(const Description& description, const Lookup& lookup, Model& model, ErrorList& errors) {
  if (model.rigid_bodies.empty()) {
    return;
  }
  for (const Fixed& fixed : description.fixed) {
    check_set(fixed.set, "held", fixed.place, lookup, model, errors);
  }
  for (const Prescribed& prescribed : description.prescribed) {
    check_set(prescribed.set, "moved", prescribed.place, lookup, model, errors);
  }
  for (const Symmetry& symmetry : description.symmetry) {
    for (const RigidBody& rigid : model.rigid_bodies) {
      const Body& body = model.bodies[at(rigid.body)];
      if (count_in(lookup.nodes(symmetry.set), body) > 0) {
        errors.add(symmetry.place,
                   fmt::format("set \"{}\" of a plane of symmetry has nodes of body \"{}\", which is rigid",
                               symmetry.set, body.name),
                   "no nodes of rigid bodies", "leave the body out of the set, and hold it with [[fixed]] and axes");
        break;
      }
    }
  }
  constexpr unsigned every_dof = 0x3FU;
  for (RigidBody& rigid : model.rigid_bodies) {
    Body& body = model.bodies[at(rigid.body)];
    for_each_at(model.fixed, body.nodes.begin, [&](const FixedNode& fixed) { body.barrier = fixed.mask == every_dof; });
    take_conditions(model, rigid);
  }
  erase_moving(model, model.fixed);
  erase_moving(model, model.oblique);
  erase_moving(model, model.prescribed);
}

}  // namespace fexp::model
