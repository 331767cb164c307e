// SPDX-License-Identifier: Apache-2.0
#include "model/build_walls.hpp"

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
  for (std::size_t i = 0; i < model.curves.size(); ++i) {
    wall.curve = model.curves[i].name == given.curve ? static_cast<Index>(i) : wall.curve;
  }
  return wall;
}

}  // namespace

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
