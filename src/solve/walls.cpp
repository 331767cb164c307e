// SPDX-License-Identifier: Apache-2.0
#include "solve/walls.hpp"

#include "base/pack.hpp"

namespace fexp::solve {

namespace {

double wall_stiffness(const model::Model& model, const model::Wall& wall, Index node) noexcept {
  if (wall.stiffness >= 0.0) {
    return wall.stiffness;
  }
  const double stiffness = model.contact_stiffness[at(node)];
  // A wall without mass is a side that does not give way, as a barrier is.
  return wall.body == no_index ? stiffness : stiffness * wall.mass_stiffness / (stiffness + wall.mass_stiffness);
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

WallDistance wall_distance(const model::Wall& wall, const Vec3d& point, const Vec3d& position) noexcept {
  Vec3d arm = position - point;
  if (wall.shape == model::WallShape::plane) {
    return {dot(arm, wall.direction), wall.direction};
  }
  if (wall.shape == model::WallShape::cylinder) {
    arm -= dot(arm, wall.direction) * wall.direction;
  }
  const double length = square_root(dot(arm, arm));
  // On the axis or in the centre there is no way that is shorter than the others.
  const double scale = length > 0.0 ? (wall.inside ? -1.0 : 1.0) / length : 0.0;
  return {wall.inside ? wall.radius - length : length - wall.radius, scale * arm};
}

WallReaction wall_reaction(const model::Model& model, const model::Wall& wall, const Vec3d& point, Index node,
                           const Vec3d& position) noexcept {
  const auto [distance, normal] = wall_distance(wall, point, position);
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
  const double inverse_mass = 1.0 / model.mass[at(node)] + wall.inverse_mass;
  if (wall.inverse_mass > 0.0) {
    reaction.damping = 2.0 * wall.drag.damping * square_root(reaction.stiffness / inverse_mass);
  }
  if (slip.dt == 0.0) {
    reaction.energy += physics::stored_energy(drag, reaction.normal, reaction.stiffness);
  } else {
    const physics::Drag now = physics::drag_of(
        wall.drag,
        {reaction.normal, dot(reaction.force, reaction.normal), reaction.stiffness, inverse_mass, slip.way, slip.dt},
        before);
    drag = now.force;
    reaction.energy += now.stored;
    dissipated = now.dissipated;
  }
  reaction.force += drag;
  reaction.stiffness *= wall.drag.frequency2_factor();
  return dissipated;
}

double joined_frequency2(double nodes2, const WallTouch& touch, double inverse_mass) noexcept {
  const double own2 = inverse_mass * touch.stiffness, rate = inverse_mass * touch.damping;
  if (!(rate > 0.0)) {
    return nodes2 + own2;
  }
  // The dt of own2 dt^2/4 + rate dt/2 = 1 is 2 over this.
  const double own = 0.5 * rate + square_root(0.25 * rate * rate + own2);
  const double sum = square_root(nodes2) + own;
  return sum * sum;
}

}  // namespace fexp::solve
