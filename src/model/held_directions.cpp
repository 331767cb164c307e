// SPDX-License-Identifier: Apache-2.0
#include "model/held_directions.hpp"

namespace fexp::model {

namespace {

constexpr std::array<Vec3d, 3> model_axes{Vec3d{1.0, 0.0, 0.0}, Vec3d{0.0, 1.0, 0.0}, Vec3d{0.0, 0.0, 1.0}};

}  // namespace

std::array<Vec3d, 3> unit_axes(const std::optional<LocalAxes>& axes) {
  if (!axes) {
    return model_axes;
  }
  const Vec3d x = (1.0 / norm(axes->x)) * axes->x, normal = cross(x, axes->xy);
  const Vec3d z = (1.0 / norm(normal)) * normal;
  return {x, cross(z, x), z};
}

bool are_model_axes(const std::array<Vec3d, 3>& axes) noexcept { return axes == model_axes; }

Vec3d free_part(const Model& model, Index node, bool angular, const Vec3d& direction) {
  Vec3d rest = direction;
  for_each_at(model.fixed, node, [&](const FixedNode& fixed) {
    const unsigned mask = angular ? fixed.mask >> 3U : fixed.mask;
    rest = {(mask & 1U) != 0 ? 0.0 : rest.x, (mask & 2U) != 0 ? 0.0 : rest.y, (mask & 4U) != 0 ? 0.0 : rest.z};
  });
  for_each_at(model.symmetry, node, [&](const SymmetryNode& symmetry) {
    const Vec3d along = dot(rest, symmetry.normal) * symmetry.normal;
    rest = angular ? along : rest - along;
  });
  for_each_at(model.oblique, node, [&](const ObliqueNode& oblique) {
    if (oblique.angular == angular) {
      rest -= dot(rest, oblique.direction) * oblique.direction;
    }
  });
  return rest;
}

}  // namespace fexp::model
