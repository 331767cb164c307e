// SPDX-License-Identifier: Apache-2.0
#include "solve/walls.hpp"

#include "base/pack.hpp"

namespace fexp::solve {

namespace {

double wall_stiffness(const model::Model& model, const model::Wall& wall, Index node) noexcept {
  return wall.stiffness >= 0.0 ? wall.stiffness : model.contact_stiffness[at(node)];
}

}  // namespace

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
    return {{}, 0.0, 0.0, normal};
  }
  const double stiffness = wall_stiffness(model, wall, node);
  return {(stiffness * depth) * normal, 0.5 * stiffness * depth * depth, stiffness, normal};
}

double rub(const model::Model& model, const model::Wall& wall, const WallSlip& slip, Index node, WallReaction& reaction,
           Vec3d& drag) noexcept {
  const Vec3d before = drag;
  double dissipated = 0.0;
  if (!(reaction.stiffness > 0.0)) {
    if (before != Vec3d{}) {  // What was stored is lost.
      drag = {};
      dissipated = physics::stored_energy(before, reaction.normal, wall_stiffness(model, wall, node)) -
                   0.5 * dot(before, slip.way);
    }
    return dissipated;
  }
  if (slip.dt == 0.0) {
    reaction.energy += physics::stored_energy(drag, reaction.normal, reaction.stiffness);
  } else {
    const physics::Drag now = physics::drag_of(wall.drag,
                                               {reaction.normal, dot(reaction.force, reaction.normal),
                                                reaction.stiffness, 1.0 / model.mass[at(node)], slip.way, slip.dt},
                                               before);
    drag = now.force;
    reaction.energy += now.stored;
    dissipated = now.dissipated;
  }
  reaction.force += drag;
  reaction.stiffness *= wall.drag.frequency2_factor();
  return dissipated;
}

}  // namespace fexp::solve
