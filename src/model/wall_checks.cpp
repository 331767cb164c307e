// SPDX-License-Identifier: Apache-2.0
#include "model/wall_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/check_tools.hpp"
#include "model/model.hpp"

namespace fexp::model {

namespace {

/// A wall moves in one way, if it moves.
void check_wall_motion(std::string_view kind, const RigidWall& wall, const std::vector<Curve>& curves,
                       ErrorList& errors) {
  const std::string name = fmt::format("{} \"{}\"", kind, wall.name);
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
    check_wall_motion("plane", plane, description.curves, errors);
  }
  for (const RigidCylinder& cylinder : description.cylinders) {
    if (!has_direction(cylinder.axis)) {
      errors.add(cylinder.place, fmt::format("the axis of cylinder \"{}\" has no direction", cylinder.name),
                 "a vector that is not zero", "correct the axis");
    }
    check_wall_motion("cylinder", cylinder, description.curves, errors);
  }
  for (const RigidSphere& sphere : description.spheres) {
    check_wall_motion("sphere", sphere, description.curves, errors);
  }
}

}  // namespace fexp::model
