// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "model/model.hpp"
#include "model/state.hpp"

/// Whether surfaces have come through each other.
namespace fexp::test {

inline double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Whether the segment p q cuts the triangle; what only touches it does not.
inline bool cuts(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  if (!(volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) < 0.0)) {
    return false;
  }
  const double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

/// Pairs of triangles without a common node of which one has an edge that cuts the other: mid-surfaces that have come
/// through each other. Every pair is tried.
inline int crossings(const model::Model& model, const model::State& state) {
  const auto corners = [&](Index element) {
    const auto& t = model.triangle[at(element)];
    return std::array{state.motion[at(t[0])].position, state.motion[at(t[1])].position,
                      state.motion[at(t[2])].position};
  };
  int count = 0;
  for (Index e = 0; e < model.element_count(); ++e) {
    const std::array<Vec3d, 3> a = corners(e);
    Box box;
    for (const Vec3d& x : a) {
      box.include(x);
    }
    for (Index other = e + 1; other < model.element_count(); ++other) {
      const std::array<Vec3d, 3> b = corners(other);
      Box other_box;
      for (const Vec3d& x : b) {
        other_box.include(x);
      }
      bool met = false;
      for (const Index n : model.triangle[at(e)]) {
        for (const Index m : model.triangle[at(other)]) {
          met = met || n == m;
        }
      }
      if (met || !box.overlaps(other_box)) {
        continue;
      }
      bool cut = false;
      for (std::size_t i = 0; i < 3; ++i) {
        cut = cut || cuts(a[i], a[(i + 1) % 3], b) || cuts(b[i], b[(i + 1) % 3], a);
      }
      count += cut ? 1 : 0;
    }
  }
  return count;
}

}  // namespace fexp::test
