// SPDX-License-Identifier: Apache-2.0
#include "model/build_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/build.hpp"
#include "model/condition_lookup.hpp"
#include "model/held_directions.hpp"

namespace fexp::model {

namespace {

/// What all shapes of walls have.
Wall wall_of(const RigidWall& given, WallShape shape, const Vec3d& point, const Vec3d& direction, const Model& model) {
  Wall wall;
  wall.name = given.name;
  wall.shape = shape;
  wall.point = point;
  wall.direction = shape == WallShape::sphere ? Vec3d{} : (1.0 / norm(direction)) * direction;
  wall.stiffness = given.stiffness;
  wall.drag = {given.friction.value_or(model.contact.friction), given.damping.value_or(model.contact.damping)};
  const bool displaced = given.displacement != Vec3d{};
  wall.moves = displaced || given.velocity != Vec3d{};
  wall.kind = displaced ? PrescribedKind::displacement : PrescribedKind::velocity;
  wall.motion = displaced ? given.displacement : given.velocity;
  wall.inverse_mass = given.mass > 0.0 ? 1.0 / given.mass : 0.0;
  for (std::size_t i = 0; i < model.curves.size(); ++i) {
    wall.curve = model.curves[i].name == given.curve ? static_cast<Index>(i) : wall.curve;
  }
  return wall;
}

/// Two unit vectors orthogonal to a direction and to each other.
std::vector<Vec3d> across(const Vec3d& direction) {
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  const Vec3d other{x <= y && x <= z ? 1.0 : 0.0, y < x && y <= z ? 1.0 : 0.0, z < x && z < y ? 1.0 : 0.0};
  const std::array<Vec3d, 3> axes = unit_axes(LocalAxes{direction, other});
  return {axes[1], axes[2]};
}

/// The walls of the deck in the order of the model.
std::vector<const RigidWall*> given_walls(const Description& description) {
  std::vector<const RigidWall*> walls;
  const auto add = [&](const auto& list) {
    for (const RigidWall& wall : list) {
      walls.push_back(&wall);
    }
  };
  add(description.planes);
  add(description.cylinders);
  add(description.spheres);
  return walls;
}

/// A node without elements.
Index add_node(const RigidWall& given, const Wall& wall, const std::vector<Vec3d>& held, Model& model) {
  constexpr std::uint8_t rotations = 0x38U;
  const Index node = model.node_count();
  Vec3d velocity = given.initial_velocity;
  for (const Vec3d& direction : held) {
    velocity -= dot(velocity, direction) * direction;
    model.oblique.push_back({node, direction, false});
  }
  model.fixed.push_back({node, rotations});
  model.reference_position.push_back(wall.point);
  model.initial_velocity.push_back(velocity);
  model.initial_rotation_rate.emplace_back();
  model.mass.push_back(given.mass);
  model.inertia.push_back(1.0);  // It does not turn
  model.half_thickness.push_back(0.0);
  model.contact_stiffness.push_back(0.0);
  model.node_size.push_back(0.0);
  model.node_body.push_back(model.body_count());
  model.corner_start.push_back(model.corner_start.back());
  model.node_label.push_back(0);
  model.point_masses.push_back({node, given.mass, 0.0});
  if (!model.ties.empty()) {
    model.ties.mass.push_back(given.mass);
    model.ties.inertia.push_back(1.0);
  }
  if (given.force != Vec3d{}) {
    model.forces.push_back({node, given.force, {}, Lookup(model).curve(given.curve)});
  }
  return node;
}

}  // namespace

std::vector<Vec3d> held_directions(const RigidWall& wall, WallShape shape, const Vec3d& direction) {
  if (wall.guide) {
    return across(*wall.guide);
  }
  if (!wall.free) {
    switch (shape) {
      case WallShape::plane:
        return across(direction);
      case WallShape::cylinder:
        return {(1.0 / norm(direction)) * direction};
      case WallShape::sphere:
        break;
    }
    return {};
  }
  std::vector<Vec3d> held;
  const std::array<Vec3d, 3> axes = unit_axes({});
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (std::find(wall.free->begin(), wall.free->end(), direction_names[axis]) == wall.free->end()) {
      held.push_back(axes[axis]);
    }
  }
  return held;
}

void build_wall_bodies(const Description& description, Model& model) {
  const std::vector<const RigidWall*> given = given_walls(description);
  Box box;
  for (const Vec3d& position : model.reference_position) {
    box.include(position);
  }
  const Vec3d edges = box.high - box.low;
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    Wall& wall = model.walls[w];
    if (wall.inverse_mass == 0.0) {
      continue;
    }
    const IndexRange elements{model.element_count(), model.element_count()};
    const IndexRange blocks{model.block_count(), model.block_count()};
    const auto end_of = [](const auto& list) { return static_cast<Index>(list.size()); };
    Body body;
    body.name = wall.name;
    body.family = wall.name;
    body.description = no_index;
    body.elements = elements;
    body.blocks = blocks;
    body.fixed.begin = end_of(model.fixed);
    body.oblique.begin = end_of(model.oblique);
    body.forces.begin = end_of(model.forces);
    const Index node = add_node(*given[w], wall, held_directions(*given[w], wall.shape, wall.direction), model);
    body.nodes = {node, node + 1};
    body.fixed.end = end_of(model.fixed);
    body.oblique.end = end_of(model.oblique);
    body.forces.end = end_of(model.forces);
    body.mass = given[w]->mass;
    body.wall = static_cast<Index>(w);
    wall.body = model.body_count();
    const double frequency = penalty_courant / model.first_critical_step;
    wall.mass_stiffness = model.contact.penalty_scale * given[w]->mass * frequency * frequency;
    wall.span = std::max({edges.x, edges.y, edges.z});
    model.bodies.push_back(std::move(body));
  }
}

void build_walls(const Description& description, Model& model) {
  for (const RigidPlane& plane : description.planes) {
    model.walls.push_back(wall_of(plane, WallShape::plane, plane.point, plane.normal, model));
  }
  for (const RigidCylinder& cylinder : description.cylinders) {
    Wall& wall = model.walls.emplace_back(wall_of(cylinder, WallShape::cylinder, cylinder.point, cylinder.axis, model));
    wall.radius = cylinder.radius;
    wall.inside = cylinder.inside;
  }
  for (const RigidSphere& sphere : description.spheres) {
    Wall& wall = model.walls.emplace_back(wall_of(sphere, WallShape::sphere, sphere.centre, {}, model));
    wall.radius = sphere.radius;
    wall.inside = sphere.inside;
  }
  for (Wall& wall : model.walls) {
    wall.rubbing = wall.drag.acts() ? model.rubbing_walls++ : no_index;
  }
}

}  // namespace fexp::model
