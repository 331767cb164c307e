// SPDX-License-Identifier: Apache-2.0
#include "model/wall_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "model/build_walls.hpp"
#include "model/check_tools.hpp"
#include "model/model.hpp"

namespace fexp::model {

namespace {

/// What only a wall with mass can have, by its key; empty where there is nothing of it.
std::string_view key_of_mass(const RigidWall& wall) {
  return wall.force != Vec3d{}              ? "force"
         : wall.initial_velocity != Vec3d{} ? "initial_velocity"
         : wall.free                        ? "free"
         : wall.guide                       ? "guide"
                                            : "";
}

/// What a wall with mass is told fits together.
void check_mass(const std::string& name, const RigidWall& wall, const std::vector<Vec3d>& held, ErrorList& errors) {
  constexpr double least_part = 1.0e-6;  // Of vectors that are written with six digits
  if (wall.velocity != Vec3d{} || wall.displacement != Vec3d{}) {
    errors.add(wall.place,
               fmt::format("{} has a mass and a {}", name, wall.velocity != Vec3d{} ? "velocity" : "displacement"),
               "a mass, or a motion that it is told",
               "leave one of them out; the velocity with which a mass begins is its initial_velocity");
  }
  if (!wall.curve.empty() && wall.force == Vec3d{}) {
    errors.add(wall.place, fmt::format("{} names a curve and has no force", name), "a curve with a force",
               "add the force, or leave the curve out");
  }
  if (held.size() == 3) {
    errors.add(wall.place, fmt::format("{} has a mass and is free in no direction", name), "one direction at least",
               "name the directions in free, or leave the mass out");
  }
  for (const Vec3d& direction : held) {
    if (std::abs(dot(direction, wall.initial_velocity)) > least_part * norm(wall.initial_velocity)) {
      errors.add(wall.place, fmt::format("{} has an initial_velocity along which it is not free", name),
                 "a velocity in its free directions", "correct it, or free or guide");
      break;
    }
  }
}

/// Whether a wall's mass can be looked at: its directions are there.
bool check_directions(const std::string& name, const RigidWall& wall, ErrorList& errors) {
  if (wall.guide && !has_direction(*wall.guide)) {
    errors.add(wall.place, fmt::format("the guide of {} has no direction", name), "a vector that is not zero",
               "correct the guide");
    return false;
  }
  if (wall.guide && wall.free) {
    errors.add(wall.place, fmt::format("{} has free directions and a guide", name), "one of them", "keep one of them");
    return false;
  }
  return true;
}

/// A wall moves in one way, if it moves. `direction`: normal or axis, which may have no length yet.
void check_wall_motion(std::string_view kind, const RigidWall& wall, WallShape shape, const Vec3d& direction,
                       const std::vector<Curve>& curves, ErrorList& errors) {
  const std::string name = fmt::format("{} \"{}\"", kind, wall.name);
  if (wall.mass > 0.0) {
    if (check_directions(name, wall, errors) && (shape == WallShape::sphere || has_direction(direction))) {
      check_mass(name, wall, held_directions(wall, shape, direction), errors);
    }
    return;
  }
  if (const std::string_view key = key_of_mass(wall); !key.empty()) {
    errors.add(wall.place, fmt::format("{} has a key {} and no mass", name, key), "a mass > 0 with it",
               fmt::format("give it a mass, or leave {} out", key));
    return;
  }
  const bool moved = wall.velocity != Vec3d{}, displaced = wall.displacement != Vec3d{};
  if (moved && displaced) {
    errors.add(wall.place, fmt::format("{} has a velocity and a displacement", name), "one of them",
               "keep one of them");
  } else if (displaced) {
    check_displacement(name, wall.curve, curves, wall.place, errors);
  } else if (!moved && !wall.curve.empty()) {
    errors.add(wall.place, fmt::format("{} names a curve and does not move", name),
               "a curve with a velocity or a displacement", "add one of them, or leave the curve out");
  }
}

}  // namespace

void check_displacement(const std::string& name, const std::string& curve_name, const std::vector<Curve>& curves,
                        const Place& place, ErrorList& errors) {
  const auto curve =
      std::find_if(curves.begin(), curves.end(), [&](const Curve& candidate) { return candidate.name == curve_name; });
  if ((curve == curves.end() && !curve_name.empty()) || (curve != curves.end() && curve->points.empty())) {
    return;
  }
  double start = 1.0;
  bool jumps = false;
  if (curve != curves.end()) {
    const auto& points = curve->points;
    start = value_of(*curve, 0.0);
    for (std::size_t i = 1; i < points.size(); ++i) {
      jumps = jumps || points[i][0] == points[i - 1][0];
    }
  }
  if (start != 0.0 || jumps) {
    errors.add(place,
               start != 0.0 ? fmt::format("the displacement of {} is {:g} times its size at the start", name, start)
                            : fmt::format("the displacement of {} jumps", name),
               "a curve that is 0 at time 0 and has no time twice", "let the displacement grow from zero by its curve");
  }
}

void check_walls(const Description& description, ErrorList& errors) {
  check_names("plane", description.planes, {}, errors);
  const std::vector<std::string> planes = names_of(description.planes), cylinders = names_of(description.cylinders);
  std::set<std::string> taken(planes.begin(), planes.end());
  check_names("wall", description.cylinders, taken, errors);
  taken.insert(cylinders.begin(), cylinders.end());
  check_names("wall", description.spheres, taken, errors);
  for (const RigidPlane& plane : description.planes) {
    if (!has_direction(plane.normal)) {
      errors.add(plane.place, fmt::format("the normal of plane \"{}\" has no direction", plane.name),
                 "a vector that is not zero", "correct the normal");
    }
    check_wall_motion("plane", plane, WallShape::plane, plane.normal, description.curves, errors);
  }
  for (const RigidCylinder& cylinder : description.cylinders) {
    if (!has_direction(cylinder.axis)) {
      errors.add(cylinder.place, fmt::format("the axis of cylinder \"{}\" has no direction", cylinder.name),
                 "a vector that is not zero", "correct the axis");
    }
    check_wall_motion("cylinder", cylinder, WallShape::cylinder, cylinder.axis, description.curves, errors);
  }
  for (const RigidSphere& sphere : description.spheres) {
    check_wall_motion("sphere", sphere, WallShape::sphere, {}, description.curves, errors);
  }
  const std::vector<std::string> bodies = names_of(description.bodies);
  const auto check_body_names = [&](const auto& walls) {
    for (const RigidWall& wall : walls) {
      if (wall.mass > 0.0 && std::ranges::find(bodies, wall.name) != bodies.end()) {
        errors.add(wall.place, fmt::format("the name \"{}\" is already that of a body", wall.name),
                   "a name of its own, as a wall with mass counts as a body", "rename one of them");
      }
    }
  };
  check_body_names(description.planes);
  check_body_names(description.cylinders);
  check_body_names(description.spheres);
}

}  // namespace fexp::model
