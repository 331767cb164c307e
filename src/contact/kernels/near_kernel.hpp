// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "contact/near_pairs.hpp"

namespace fexp::contact::kernels {

using model::block_lanes;

/// Twice the area over the square of the longest edge, below which a triangle is a sliver.
inline constexpr double sliver_sine = 1.0e-4;
/// Part of the square of a bound that counts, so that the rounding of normals cannot make it too large.
inline constexpr double bound_part = 0.98;

template <class T>
FEXP_INLINE Vec3<T> load_vector(const BlockTriangles& triangles, Index row, std::size_t lane) noexcept {
  return {T::load(&triangles.rows[at(row)][lane]), T::load(&triangles.rows[at(row + 1)][lane]),
          T::load(&triangles.rows[at(row + 2)][lane])};
}
template <class T>
FEXP_INLINE void store_vector(const Vec3<T>& v, BlockTriangles& triangles, Index row, std::size_t lane) noexcept {
  v.x.store(&triangles.rows[at(row)][lane]);
  v.y.store(&triangles.rows[at(row + 1)][lane]);
  v.z.store(&triangles.rows[at(row + 2)][lane]);
}

/// 1 / a, and 0 where a is 0.
template <class T>
FEXP_INLINE T inverse_or_zero(const T& a) noexcept {
  return select_less(T(0.0), a, T(1.0) / a, T(0.0));
}

template <class T>
FEXP_INLINE Vec3<T> smaller(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
template <class T>
FEXP_INLINE Vec3<T> larger(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}

template <class T>
void prepare(const SearchGeometry& g, const model::ElementBlock& block, BlockTriangles& triangles) noexcept {
  constexpr auto width = static_cast<std::size_t>(T::width);
  triangles.count = block.count;
  for (std::size_t lane = 0; lane < at(block_lanes); lane += width) {
    std::array<Vec3<T>, 3> corner;
    T thickest(0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<const double*, width> nodes;
      T half;
      for (std::size_t i = 0; i < width; ++i) {
        const Index place = static_cast<Index>(lane + i) < block.count ? static_cast<Index>(lane + i) : block.count - 1;
        const Index node = g.triangle[block.first + place][c];
        triangles.rows[at(row_node) + c][lane + i] = static_cast<double>(node);
        nodes[i] = &g.motion[node].position.x;
        half.v[i] = g.half_thickness[node];
      }
      // More than the position, because whole rows are faster.
      std::array<T, 8> x;
      load_rows(nodes, x);
      corner[c] = {x[0], x[1], x[2]};
      thickest = maximum(thickest, half);
    }
    const Vec3<T> normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    T longest2(0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto row = static_cast<Index>(3 * c);
      const Vec3<T> edge = corner[(c + 1) % 3] - corner[c];
      store_vector(corner[c], triangles, row_corner + row, lane);
      store_vector(edge, triangles, row_edge + row, lane);
      store_vector(cross(normal, edge), triangles, row_inward + row, lane);
      const T edge2 = dot(edge, edge);
      inverse_or_zero(edge2).store(&triangles.rows[at(row_inverse_edge2) + c][lane]);
      longest2 = maximum(longest2, edge2);
    }
    const T normal2 = dot(normal, normal), inverse_normal2 = inverse_or_zero(normal2);
    store_vector(normal, triangles, row_normal, lane);
    inverse_normal2.store(&triangles.rows[at(row_inverse_normal2)][lane]);
    const T usable = select_less(T(sliver_sine * sliver_sine) * longest2 * longest2, normal2, inverse_normal2, T(0.0));
    (T(bound_part) * usable).store(&triangles.rows[at(row_bound_scale)][lane]);
    const T margin = (thickest + T(g.skin)) * T(1.0 + distance_rounding);
    const Vec3<T> margins{margin, margin, margin};
    store_vector(smaller(corner[0], smaller(corner[1], corner[2])) - margins, triangles, row_low, lane);
    store_vector(larger(corner[0], larger(corner[1], corner[2])) + margins, triangles, row_high, lane);
    (thickest * T(1.0 + distance_rounding)).store(&triangles.rows[at(row_watched)][lane]);
  }
}

/// How a point lies to triangles.
template <class T>
struct PointAndTriangles {
  std::array<Vec3<T>, 3> from;  // From the corners [length]
  T least_inside{};             // Negative where the foot on the plane lies outside
  T plane2{};                   // Square of the distance to the plane [length^2]
  T bound2{};                   // Square of a distance that no point of the triangle is nearer than [length^2]

  FEXP_INLINE PointAndTriangles(const BlockTriangles& triangles, const Vec3<T>& point, std::size_t lane) noexcept {
    std::array<T, 3> inside, beyond;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto row = static_cast<Index>(3 * c);
      from[c] = point - load_vector<T>(triangles, row_corner + row, lane);
      inside[c] = dot(from[c], load_vector<T>(triangles, row_inward + row, lane));
      const T outside = minimum(inside[c], T(0.0));
      beyond[c] = outside * outside * T::load(&triangles.rows[at(row_inverse_edge2) + c][lane]);
    }
    const T height = dot(from[0], load_vector<T>(triangles, row_normal, lane));
    const T scale = T::load(&triangles.rows[at(row_bound_scale)][lane]);
    plane2 = height * height * T::load(&triangles.rows[at(row_inverse_normal2)][lane]);
    least_inside = minimum(inside[0], minimum(inside[1], inside[2]));
    bound2 = maximum(height * height, maximum(beyond[0], maximum(beyond[1], beyond[2]))) * scale;
  }

  /// Square of the distance: to the nearest point of the edges, or of the plane where its foot is inside. The twin of
  /// physics::closest_point, without branches and rounded otherwise.
  [[nodiscard]] FEXP_INLINE T distance2(const BlockTriangles& triangles, std::size_t lane) const noexcept {
    std::array<T, 3> edge2;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3<T> edge = load_vector<T>(triangles, row_edge + static_cast<Index>(3 * c), lane);
      const T along = dot(from[c], edge) * T::load(&triangles.rows[at(row_inverse_edge2) + c][lane]);
      const Vec3<T> offset = from[c] - minimum(maximum(along, T(0.0)), T(1.0)) * edge;
      edge2[c] = dot(offset, offset);
    }
    const T to_edges = minimum(edge2[0], minimum(edge2[1], edge2[2]));
    return select_less(T(0.0), least_inside, minimum(plane2, to_edges), to_edges);
  }
};

template <class T>
Index find_near(const BlockTriangles& triangles, const NearNode* nodes, Index count, double skin,
                NearPair* found) noexcept {
  constexpr auto width = static_cast<std::size_t>(T::width);
  const auto load_row = [&triangles](Index row, std::size_t lane) { return T::load(&triangles.rows[at(row)][lane]); };
  NearPair* next = found;
  for (Index n = 0; n < count; ++n) {
    const NearNode& node = nodes[n];
    const Vec3<T> point{T(node.point.x), T(node.point.y), T(node.point.z)};
    const T reach(node.reach), number(static_cast<double>(node.node));
    for (std::size_t lane = 0; lane < at(block_lanes); lane += width) {
      const Vec3<T> outside =
          larger(load_vector<T>(triangles, row_low, lane) - point, point - load_vector<T>(triangles, row_high, lane));
      unsigned near = lanes_at_most(maximum(outside.x, maximum(outside.y, outside.z)), reach);
      // Most of what lies in the box are a triangle's own corners.
      near &= ~(lanes_equal(load_row(row_node, lane), number) | lanes_equal(load_row(row_node + 1, lane), number) |
                lanes_equal(load_row(row_node + 2, lane), number));
      if (near == 0) {
        continue;
      }
      const T watched = reach + load_row(row_watched, lane);
      const T farthest = watched + T(skin * (1.0 + distance_rounding));
      const PointAndTriangles<T> situation(triangles, point, lane);
      near &= lanes_at_most(situation.bound2, farthest * farthest);
      if (near == 0) {
        continue;
      }
      const T slack = square_root(situation.distance2(triangles, lane)) * T(1.0 - distance_rounding) - watched;
      for (near &= lanes_at_most(slack, T(skin)); near != 0; near &= near - 1) {
        const int i = __builtin_ctz(near);
        if (static_cast<Index>(lane) + i < triangles.count) {
          *next++ = {n, static_cast<Index>(lane) + i, slack.lane(i)};
        }
      }
    }
  }
  return static_cast<Index>(next - found);
}

[[nodiscard]] NearKernel near_baseline() noexcept;
[[nodiscard]] NearKernel near_avx2() noexcept;
[[nodiscard]] NearKernel near_avx512() noexcept;

}  // namespace fexp::contact::kernels
