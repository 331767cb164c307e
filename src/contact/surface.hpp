// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "model/model.hpp"
#include "model/state.hpp"
#include "physics/closest_point.hpp"
#include "physics/drag.hpp"

namespace fexp::contact {

/// Positions of nodes now, or `back` earlier along their velocities, and what is left of the surface between them.
struct Positions {
  const model::NodeMotion* motion{};  // [nodes]
  double back{};                      ///< [time]
  const double* layers{};             ///< Those of the state where elements can fail, else null
  bool still{};                       ///< No step has been taken, see model::is_deleted
  const model::TieState* ties{};      ///< Those of the state where ties can break, else null

  [[nodiscard]] Vec3d operator()(Index node) const noexcept {
    const model::NodeMotion& m = motion[node];
    return back == 0.0 ? m.position : m.position - back * m.velocity;
  }
  [[nodiscard]] bool has(const model::Model& model, Index element) const noexcept {
    return layers == nullptr || has_left(model, element);
  }
  /// Whether an element of the node is left.
  [[nodiscard]] bool has_surface_at(const model::Model& model, Index node) const noexcept {
    return layers == nullptr || has_left_at(model, node);
  }

 private:
  [[nodiscard]] bool has_left(const model::Model& model, Index element) const noexcept;
  [[nodiscard]] bool has_left_at(const model::Model& model, Index node) const noexcept;
};

/// Whether a tie joins two nodes now. One that has broken does so still where it was on the very triangle: nobody could
/// tell on which side of that the node belongs.
[[nodiscard]] bool are_joined(const model::Model& model, const Positions& x, Index a, Index b) noexcept;

[[nodiscard]] inline physics::ClosestPoint closest_on(const model::Model& model, const Positions& x, Index element,
                                                      const Vec3d& point) noexcept {
  const auto& t = model.triangle[at(element)];
  return physics::closest_point(point, x(t[0]), x(t[1]), x(t[2]));
}

/// Calls visit(other) for every other element that shares the feature on which a closest point of `element` lies: none
/// for the face, those at an edge, all elements round a corner in ascending order. Deleted ones are not there.
template <class Visit>
void for_each_sharing(const model::Model& model, const Positions& x, Index element, physics::Feature feature,
                      const Visit& visit) {
  const auto visit_left = [&](Index other) {
    if (x.has(model, other)) {
      visit(other);
    }
  };
  if (physics::is_edge(feature)) {
    model::for_each_at_edge(model, 3 * element + static_cast<Index>(physics::number_of(feature)), visit_left);
  } else if (physics::is_corner(feature)) {
    const Index node = model.triangle[at(element)][physics::number_of(feature)];
    for (Index c = model.corner_start[at(node)]; c < model.corner_start[at(node) + 1]; ++c) {
      const Index other = model.corner[at(c)] / 3;
      if (other != element) {
        visit_left(other);
      }
    }
  }
}

/// The same for those alone that go on from the element over the feature, and agree with it about the side. Where more
/// than two elements meet at an edge, others end there.
template <class Visit>
void for_each_going_on(const model::Model& model, const Positions& x, Index element, physics::Feature feature,
                       const Visit& visit) {
  if (model.corner_fan.empty()) {
    for_each_sharing(model, x, element, feature, visit);
  } else if (physics::is_edge(feature)) {
    const Index other = model.neighbour[at(element)][physics::number_of(feature)];
    if (other != no_index && x.has(model, other)) {
      visit(other);
    }
  } else if (physics::is_corner(feature)) {
    const auto own = static_cast<Index>(physics::number_of(feature));
    const Index node = model.triangle[at(element)][at(own)], fan = model.corner_fan[at(3 * element + own)];
    for (Index c = model.corner_start[at(node)]; c < model.corner_start[at(node) + 1]; ++c) {
      const Index corner = model.corner[at(c)], other = corner / 3;
      if (other != element && model.corner_fan[at(corner)] == fan && x.has(model, other)) {
        visit(other);
      }
    }
  }
}

/// Whether `other`, which shares the feature, goes on from the element there.
[[nodiscard]] bool goes_on(const model::Model& model, Index element, physics::Feature feature, Index other) noexcept;

/// Whether the feature lies on the rim of an open surface, or where the element ends at others, where a node may go
/// round from one side to the other.
[[nodiscard]] bool is_on_rim(const model::Model& model, const Positions& x, Index element,
                             physics::Feature feature) noexcept;

/// Unit normals of elements at given positions. Each is asked for again and again by the pairs near it, and takes a
/// root and a division, so that some are kept.
class Normals {
 public:
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): `kept_` is read only where `element_` says so
  Normals(const model::Model& model, const Positions& positions) noexcept : model_(model), positions_(positions) {
    element_.fill(no_index);
  }

  [[nodiscard]] const Positions& positions() const noexcept { return positions_; }

  [[nodiscard]] Vec3d operator()(Index element) noexcept {
    const std::size_t place = at(element) % places;
    std::array<double, 3>& kept = kept_[place];
    if (element_[place] != element) {
      element_[place] = element;
      const auto& t = model_.triangle[at(element)];
      const Vec3d origin = positions_(t[0]);
      const Vec3d normal = cross(positions_(t[1]) - origin, positions_(t[2]) - origin);
      const Vec3d unit = (1.0 / norm(normal)) * normal;
      kept = {unit.x, unit.y, unit.z};
    }
    return {kept[0], kept[1], kept[2]};
  }

 private:
  static constexpr std::size_t places = 128;

  const model::Model& model_;
  Positions positions_;
  std::array<Index, places> element_;
  std::array<std::array<double, 3>, places> kept_;
};

/// How a point sees the surface round its closest point.
struct View {
  int side{};     ///< +1 where the normals point, -1 behind
  bool agreed{};  ///< All elements that share the feature say the same; off the tip of a sharp fold they do not
};

/// At an edge the element with the steepest view says which side it is. At a corner that edge does which leads least
/// away from the point, with its elements: seen along the line from the point through the corner it is the outermost
/// one, which is convex. So the side is right at every fold and every spike.
[[nodiscard]] View view_of(const model::Model& model, Normals& normals, Index element,
                           const physics::ClosestPoint& closest) noexcept;

/// Whether the deck lets the node touch the element: their bodies may, they are not both barriers, and the node is no
/// corner of the element.
[[nodiscard]] bool may_touch(const model::Model& model, Index node, Index element) noexcept;

[[nodiscard]] inline Index body_of_element(const model::Model& model, Index element) noexcept {
  return model.blocks[at(model.element_block[at(element)])].body;
}

/// The ends of an edge, from corner a to corner a + 1.
[[nodiscard]] inline std::array<Index, 2> ends_of(const model::Model& model, Index edge) noexcept {
  const auto& t = model.triangle[at(edge / 3)];
  const auto a = static_cast<std::size_t>(edge % 3);
  return {t[a], t[a == 2 ? 0 : a + 1]};
}

/// Largest half thickness at the element's corners [length].
[[nodiscard]] inline double half_thickness_of(const model::Model& model, Index element) noexcept {
  const auto& t = model.triangle[at(element)];
  const double a = model.half_thickness[at(t[0])], b = model.half_thickness[at(t[1])];
  const double c = model.half_thickness[at(t[2])];
  const double larger = a > b ? a : b;
  return larger > c ? larger : c;
}

/// Distance up to which the side of a pair is remembered [length]. The margin beyond contact distance makes sure that
/// the side is known before the node can come through in one step.
[[nodiscard]] inline double watch_distance(const model::Model& model, Index node, Index element) noexcept {
  return model.half_thickness[at(node)] + half_thickness_of(model, element) +
         model::watch_margin(model.node_size[at(node)]);
}

}  // namespace fexp::contact
