// SPDX-License-Identifier: Apache-2.0
#include "solve/walls.hpp"

#include "base/pack.hpp"

namespace fexp::solve {

Vec3d wall_point(const model::Model& model, const model::Wall& wall, double time) noexcept {
  if (!wall.moves) {
    return wall.point;
  }
  const double size = wall.kind == model::PrescribedKind::displacement ? curve_value(model, wall.curve, time)
                                                                       : curve_integral(model, wall.curve, time);
  return wall.point + size * wall.motion;
}

WallReaction wall_reaction(const model::Model& model, const model::Wall& wall, const Vec3d& point, Index node,
                           const Vec3d& position) noexcept {
  Vec3d arm = position - point;
  Vec3d normal = wall.direction;
  double distance = 0.0;  // On the free side
  if (wall.shape == model::WallShape::plane) {
    distance = dot(arm, normal);
  } else {
    if (wall.shape == model::WallShape::cylinder) {
      arm -= dot(arm, wall.direction) * wall.direction;
    }
    const double length = square_root(dot(arm, arm));
    distance = wall.inside ? wall.radius - length : length - wall.radius;
    // On the axis or in the centre there is no way that is shorter than the others.
    const double scale = length > 0.0 ? (wall.inside ? -1.0 : 1.0) / length : 0.0;
    normal = scale * arm;
  }
  const double depth = model.half_thickness[at(node)] - distance;
  if (!(depth > 0.0)) {
    return {};
  }
  const double stiffness = wall.stiffness >= 0.0 ? wall.stiffness : model.contact_stiffness[at(node)];
  return {(stiffness * depth) * normal, 0.5 * stiffness * depth * depth, stiffness};
}

}  // namespace fexp::solve
