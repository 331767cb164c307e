// SPDX-License-Identifier: Apache-2.0
#include "contact/surface.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::contact {

namespace {

using physics::Feature;

/// Whether nothing goes on from an element over its edge `a`.
bool ends_at_edge(const model::Model& model, const Positions& x, Index element, std::size_t a) noexcept {
  const Index other = model.neighbour[at(element)][a];
  return other == no_index || !x.has(model, other);
}

bool ends_at_node(const model::Model& model, const Positions& x, Index element, Index node) noexcept {
  const auto& t = model.triangle[at(element)];
  for (std::size_t a = 0; a < 3; ++a) {
    if (t[a] == node && (ends_at_edge(model, x, element, a) || ends_at_edge(model, x, element, (a + 2) % 3))) {
      return true;
    }
  }
  return false;
}

/// Whether a node is tied to a triangle at another one, and the tie keeps contact from between them.
bool is_tied_to(const model::Model& model, const model::TieState* ties, Index node, Index carrier) noexcept {
  const Index number = model.ties.tie_of(node);
  if (number == no_index) {
    return false;
  }
  const model::Tie& tie = model.ties.ties[at(number)];
  return (ties[number].broken == 0 || !(tie.length > 0.0)) &&
         std::ranges::find(tie.carrier, carrier) != tie.carrier.end();
}

/// Steepest view from the elements at that edge of the closest corner which leads least away from the point.
double view_at_outermost_edge(const model::Model& model, Normals& normals, Index element,
                              const physics::ClosestPoint& closest) noexcept {
  const Positions& x = normals.positions();
  const Index node = model.triangle[at(element)][physics::number_of(closest.feature)];
  double outermost = -HUGE_VAL, steepest = 0.0;
  const auto look_along_edges = [&](Index seen) {
    for (const Index end : model.triangle[at(seen)]) {
      if (end == node) {
        continue;
      }
      const Vec3d edge = x(end) - x(node);
      const double reach = dot(closest.offset, edge) / norm(edge);
      if (reach > outermost) {
        outermost = reach;
        steepest = 0.0;
      }
      if (reach == outermost) {
        const double view = dot(closest.offset, normals(seen));
        steepest = std::abs(view) > std::abs(steepest) ? view : steepest;
      }
    }
  };
  look_along_edges(element);
  for_each_going_on(model, x, element, closest.feature, look_along_edges);
  return steepest;
}

}  // namespace

bool are_joined(const model::Model& model, const Positions& x, Index a, Index b) noexcept {
  return model.ties.are_joined(a, b) &&
         (x.ties == nullptr || is_tied_to(model, x.ties, a, b) || is_tied_to(model, x.ties, b, a));
}

bool Positions::has_left(const model::Model& model, Index element) const noexcept {
  return !model::is_deleted(model, layers, element, still ? 1 : 0);
}

bool Positions::has_left_at(const model::Model& model, Index node) const noexcept {
  for (Index c = model.corner_start[at(node)]; c < model.corner_start[at(node) + 1]; ++c) {
    if (has_left(model, model.corner[at(c)] / 3)) {
      return true;
    }
  }
  return false;
}

bool is_on_rim(const model::Model& model, const Positions& x, Index element, Feature feature) noexcept {
  if (physics::is_edge(feature)) {
    return ends_at_edge(model, x, element, physics::number_of(feature));
  }
  if (!physics::is_corner(feature)) {
    return false;
  }
  const Index node = model.triangle[at(element)][physics::number_of(feature)];
  bool rim = ends_at_node(model, x, element, node);
  for_each_going_on(model, x, element, feature, [&](Index other) { rim = rim || ends_at_node(model, x, other, node); });
  return rim;
}

bool goes_on(const model::Model& model, Index element, Feature feature, Index other) noexcept {
  if (model.corner_fan.empty()) {
    return true;
  }
  const std::size_t own = physics::number_of(feature);
  if (physics::is_edge(feature)) {
    return model.neighbour[at(element)][own] == other;
  }
  const auto &t = model.triangle[at(element)], &s = model.triangle[at(other)];
  const auto theirs = static_cast<Index>(std::find(s.begin(), s.end(), t[own]) - s.begin());
  return model.corner_fan[at(3 * element) + own] == model.corner_fan[at(3 * other + theirs)];
}

View view_of(const model::Model& model, Normals& normals, Index element,
             const physics::ClosestPoint& closest) noexcept {
  double steepest = 0.0, lowest = HUGE_VAL, highest = -HUGE_VAL;
  const auto look_from = [&](Index seen) {
    const double view = dot(closest.offset, normals(seen));
    steepest = std::abs(view) > std::abs(steepest) ? view : steepest;
    lowest = view < lowest ? view : lowest;
    highest = view > highest ? view : highest;
  };
  look_from(element);
  for_each_going_on(model, normals.positions(), element, closest.feature, look_from);
  // Where all views are strictly of one sign, the outermost edge's is, too.
  if (physics::is_corner(closest.feature) && !(lowest > 0.0) && !(highest < 0.0)) {
    steepest = view_at_outermost_edge(model, normals, element, closest);
  }
  return {steepest < 0.0 ? -1 : 1, lowest >= 0.0 || highest <= 0.0};
}

bool may_touch(const model::Model& model, Index node, Index element) noexcept {
  const auto& t = model.triangle[at(element)];
  if (t[0] == node || t[1] == node || t[2] == node) {
    return false;
  }
  const Index a = model.node_body[at(node)], b = body_of_element(model, element);
  return !(model.bodies[at(a)].barrier && model.bodies[at(b)].barrier) && model.can_touch(a < b ? a : b, a < b ? b : a);
}

}  // namespace fexp::contact
