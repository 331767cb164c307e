// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/index.hpp"
#include "model/model.hpp"
#include "physics/closest_point.hpp"

namespace fexp::model {

/// Finds closest points on triangles in the reference configuration, for a few nodes while a model is built: triangles
/// are sorted along one axis, so that a search looks at those of a slice alone.
class SurfaceSearch {
 public:
  SurfaceSearch(const Model& model, std::span<const Index> bodies);

  struct Found {
    Index element{no_index};
    physics::ClosestPoint closest{};
  };
  /// The closest triangle, the lowest of those that are equally close, within `distance` [length]; none: no_index.
  [[nodiscard]] Found closest(const Vec3d& point, double distance) const;
  /// That wherever it is.
  [[nodiscard]] Found closest(const Vec3d& point) const;

 private:
  struct Slab {
    double low;  ///< Of the triangle along the axis [length]
    Index element;
  };
  const Model& model_;
  double Vec3d::*axis_;
  double longest_{};  // Of the triangles along the axis [length]
  std::vector<Slab> slabs_;
};

}  // namespace fexp::model
