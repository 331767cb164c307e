// SPDX-License-Identifier: Apache-2.0
#include "model/surface_search.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::model {

SurfaceSearch::SurfaceSearch(const Model& model, std::span<const Index> bodies) : model_(model), axis_(&Vec3d::x) {
  Box box;
  for (const Index b : bodies) {
    const IndexRange nodes = model.bodies[at(b)].nodes;
    for (Index n = nodes.begin; n < nodes.end; ++n) {
      box.include(model.reference_position[at(n)]);
    }
  }
  axis_ = longest_axis(box);
  for (const Index b : bodies) {
    const IndexRange elements = model.bodies[at(b)].elements;
    for (Index e = elements.begin; e < elements.end; ++e) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const Index n : model.triangle[at(e)]) {
        low = std::min(low, model.reference_position[at(n)].*axis_);
        high = std::max(high, model.reference_position[at(n)].*axis_);
      }
      slabs_.push_back({low, e});
      longest_ = std::max(longest_, high - low);
    }
  }
  std::stable_sort(slabs_.begin(), slabs_.end(), [](const Slab& a, const Slab& b) { return a.low < b.low; });
}

SurfaceSearch::Found SurfaceSearch::closest(const Vec3d& point, double distance) const {
  Found found;
  double least = distance * distance;
  const double begin = point.*axis_ - distance - longest_, end = point.*axis_ + distance;
  auto slab = std::lower_bound(slabs_.begin(), slabs_.end(), begin,
                               [](const Slab& s, double position) { return s.low < position; });
  for (; slab != slabs_.end() && slab->low <= end; ++slab) {
    const auto& t = model_.triangle[at(slab->element)];
    const physics::ClosestPoint closest =
        physics::closest_point(point, model_.reference_position[at(t[0])], model_.reference_position[at(t[1])],
                               model_.reference_position[at(t[2])]);
    const bool lower = found.element == no_index || slab->element < found.element;
    if (closest.distance2 < least || (closest.distance2 == least && lower)) {
      least = closest.distance2;
      found = {slab->element, closest};
    }
  }
  return found;
}

SurfaceSearch::Found SurfaceSearch::closest(const Vec3d& point) const {
  // Ever wider slices, until one has a triangle.
  double distance = longest_ > 0.0 ? longest_ : 1.0;
  Found found = closest(point, distance);
  while (found.element == no_index && !slabs_.empty() && std::isfinite(distance)) {
    distance *= 8.0;
    found = closest(point, distance);
  }
  return found;
}

}  // namespace fexp::model
