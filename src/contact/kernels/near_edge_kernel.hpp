// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/inline.hpp"
#include "base/pack.hpp"
#include "contact/near_edges.hpp"
#include "contact/near_pairs.hpp"

namespace fexp::contact::kernels {

template <class T>
FEXP_INLINE Vec3<T> load_vector(const BlockEdges& block, Index row, std::size_t lane) noexcept {
  return {T::load(&block.rows[at(row)][lane]), T::load(&block.rows[at(row) + 1][lane]),
          T::load(&block.rows[at(row) + 2][lane])};
}

template <class T>
FEXP_INLINE Vec3<T> same_in_all(const Vec3d& v) noexcept {
  return {T(v.x), T(v.y), T(v.z)};
}

/// Kept between the ends of an edge.
template <class T>
FEXP_INLINE T within(const T& part) noexcept {
  return minimum(maximum(part, T(0.0)), T(1.0));
}

/// An edge in all lanes.
template <class T>
struct OneEdge {
  Vec3<T> begin, along, low, high;
  T inverse2, reach, node, other_node, number;

  FEXP_INLINE explicit OneEdge(const NearEdge& edge) noexcept
      : begin(same_in_all<T>(edge.begin)),
        along(same_in_all<T>(edge.end - edge.begin)),
        low(same_in_all<T>(edge.box().low)),
        high(same_in_all<T>(edge.box().high)),
        reach(edge.reach),
        node(static_cast<double>(edge.node[0])),
        other_node(static_cast<double>(edge.node[1])),
        number(static_cast<double>(edge.number)) {
    const Vec3d way = edge.end - edge.begin;
    const double along2 = dot(way, way);
    inverse2 = T(along2 > 0.0 ? 1.0 / along2 : 0.0);
  }
};

/// Lanes whose boxes overlap that of the edge, which have none of its nodes and a lower number.
template <class T>
FEXP_INLINE unsigned may_be_near(const BlockEdges& block, const OneEdge<T>& edge, std::size_t lane) noexcept {
  const Vec3<T> above = load_vector<T>(block, edge_row_low, lane) - edge.high;
  const Vec3<T> below = edge.low - load_vector<T>(block, edge_row_high, lane);
  const T outside = maximum(maximum(maximum(above.x, below.x), maximum(above.y, below.y)), maximum(above.z, below.z));
  const unsigned near = lanes_at_most(outside, T(0.0));
  if (near == 0) {
    return 0;
  }
  const T node = T::load(&block.rows[at(edge_row_node)][lane]);
  const T other_node = T::load(&block.rows[at(edge_row_node) + 1][lane]);
  const unsigned met = lanes_equal(node, edge.node) | lanes_equal(node, edge.other_node) |
                       lanes_equal(other_node, edge.node) | lanes_equal(other_node, edge.other_node);
  return near & ~met & ~lanes_at_most(edge.number, T::load(&block.rows[at(edge_row_number)][lane]));
}

/// Square of the distance of the edge from those of the block [length^2]: the closest points of the lines, the first
/// kept on its edge, the second closest to that and kept on its own, and the first closest to that. The twin of
/// physics::edge_distance2, rounded otherwise: of parallel edges, whose lines have no closest points, any point of the
/// first will do to begin with, and where the lines are so nearly parallel that theirs are lost in rounding, too.
template <class T>
FEXP_INLINE T distance2(const BlockEdges& block, const OneEdge<T>& edge, std::size_t lane) noexcept {
  const Vec3<T> along = load_vector<T>(block, edge_row_along, lane);
  const Vec3<T> from = load_vector<T>(block, edge_row_begin, lane) - edge.begin;
  const T first2 = dot(along, along), second2 = dot(edge.along, edge.along), both = dot(along, edge.along);
  const T on_first = dot(along, from), on_second = dot(edge.along, from);
  const T normal2 = first2 * second2 - both * both;
  const T crossing = (both * on_second - on_first * second2) / normal2;
  const T start = within(select_less(T(0.0), normal2, crossing, T(0.0)));
  const T second = within((both * start + on_second) * edge.inverse2);
  const T first = within((both * second - on_first) * T::load(&block.rows[at(edge_row_inverse2)][lane]));
  const Vec3<T> between = from + first * along - second * edge.along;
  return dot(between, between);
}

template <class T>
Index find_near_edges(const BlockEdges& block, const NearEdge* edges, Index count, double skin,
                      NearEdgePair* found) noexcept {
  constexpr auto width = static_cast<std::size_t>(T::width);
  NearEdgePair* next = found;
  for (Index e = 0; e < count; ++e) {
    if (!block.box.overlaps(edges[e].box())) {
      continue;
    }
    const OneEdge<T> edge(edges[e]);
    for (std::size_t lane = 0; lane < at(block.count); lane += width) {
      unsigned near = may_be_near(block, edge, lane);
      if (near == 0) {
        continue;
      }
      const T reach = edge.reach + T::load(&block.rows[at(edge_row_reach)][lane]);
      const T farthest = (reach + T(skin)) * T(1.0 + 2.0 * distance_rounding);
      const T apart2 = distance2(block, edge, lane);
      near &= lanes_at_most(apart2, farthest * farthest);
      if (near == 0) {
        continue;
      }
      const T slack = square_root(apart2) * T(1.0 - distance_rounding) - reach;
      for (near &= lanes_at_most(slack, T(skin)); near != 0; near &= near - 1) {
        const int i = __builtin_ctz(near);
        *next++ = {static_cast<Index>(lane) + i, e, slack.lane(i)};
      }
    }
  }
  return static_cast<Index>(next - found);
}

[[nodiscard]] NearEdgeKernel near_edges_baseline() noexcept;
[[nodiscard]] NearEdgeKernel near_edges_avx2() noexcept;
[[nodiscard]] NearEdgeKernel near_edges_avx512() noexcept;

}  // namespace fexp::contact::kernels
