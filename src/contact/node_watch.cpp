// SPDX-License-Identifier: Apache-2.0
#include "contact/node_watch.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::contact {

namespace {

/// Normals of neighbours that enclose less than 60 degrees count as one smooth surface: there only the closest face
/// pushes, so that a node sliding over an edge never feels two. In sharper valleys both faces push.
constexpr double smooth_cosine = 0.5;

const model::ContactSide* find(std::span<const model::ContactSide> memory, Index element) {
  const auto found = std::lower_bound(memory.begin(), memory.end(), element,
                                      [](const model::ContactSide& s, Index e) { return s.element < e; });
  return found != memory.end() && found->element == element ? &*found : nullptr;
}

void sort_unique(std::vector<Index>& elements) {
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
}

}  // namespace

void NodeWatch::look(Index node, std::span<const Index> candidates, std::span<const model::ContactSide> memory,
                     std::vector<model::ContactSide>& remembered, std::vector<ActivePair>& active) {
  node_ = node;
  point_ = now_(node);
  gather(candidates, memory);
  measure(memory);
  if (watched_.empty()) {
    return;
  }
  decide_sides(memory);
  for (const Watched& w : watched_) {
    remembered.push_back({node_, w.element, static_cast<std::int8_t>(w.side)});
  }
  leave_one_of_smooth_neighbours();
  push(active);
}

/// Candidates, remembered elements, and the neighbours of remembered elements that the node has come through: it may
/// slide on to them at a depth at which nobody else would look for it.
void NodeWatch::gather(std::span<const Index> candidates, std::span<const model::ContactSide> memory) {
  deep_.clear();
  for (const model::ContactSide& side : memory) {
    const Watched w = measured(side.element);
    if (!w.rim && w.present_side != side.side) {
      add_ring(side.element);
    }
  }
  sort_unique(deep_);
  elements_.assign(candidates.begin(), candidates.end());
  if (memory.empty()) {
    return;
  }
  for (const model::ContactSide& side : memory) {
    elements_.push_back(side.element);
  }
  elements_.insert(elements_.end(), deep_.begin(), deep_.end());
  sort_unique(elements_);
}

void NodeWatch::add_ring(Index element) {
  for (const Index corner : model_.triangle[at(element)]) {
    for (Index c = model_.corner_start[at(corner)]; c < model_.corner_start[at(corner) + 1]; ++c) {
      const Index other = model_.corner[at(c)] / 3;
      if (may_touch(model_, node_, other)) {
        deep_.push_back(other);
      }
    }
  }
}

NodeWatch::Watched NodeWatch::measured(Index element) const {
  Watched w;
  w.element = element;
  w.closest = closest_on(model_, now_, element, point_);
  w.distance = std::sqrt(w.closest.distance2);
  w.normal = unit_normal(model_, now_, element);
  w.rim = is_on_rim(model_, element, w.closest.feature);
  w.present_side = side_of(model_, now_, element, w.closest);
  return w;
}

/// Keeps pairs within watch distance, and pairs that the node has come through down to a depth of its own size: deeper
/// ones have lost each other. Of all elements that share a feature, the closest acts (by squared distance, then
/// number).
void NodeWatch::measure(std::span<const model::ContactSide> memory) {
  watched_.clear();
  for (const Index element : elements_) {
    const double watch = watch_distance(model_, node_, element);
    const double distance2 = closest_on(model_, now_, element, point_).distance2;
    if (distance2 >= watch * watch && !is_deep(element, distance2, watch, memory)) {
      continue;
    }
    Watched w = measured(element);
    w.acts = true;
    double least = w.closest.distance2;
    Index first = element;
    for_each_sharing(model_, element, w.closest.feature, [&](Index other) {
      const double theirs = closest_on(model_, now_, other, point_).distance2;
      if (theirs < least || (theirs == least && other < first)) {
        least = theirs;
        first = other;
        w.acts = false;
        w.closer = other;
      }
    });
    watched_.push_back(w);
  }
}

/// Whether the node has come through the element, but not deeper than the pair is kept for.
bool NodeWatch::is_deep(Index element, double distance2, double watch,
                        std::span<const model::ContactSide> memory) const {
  const double deepest = watch + model_.node_size[at(node_)];
  if (distance2 >= deepest * deepest || !std::binary_search(deep_.begin(), deep_.end(), element)) {
    return false;
  }
  const Watched w = measured(element);
  const model::ContactSide* known = find(memory, element);
  return !w.rim && w.present_side == -(known != nullptr ? known->side : inherited_side(element, memory));
}

/// Side of a remembered element that is next to this one, of those across an edge first; 0 when there is none.
int NodeWatch::inherited_side(Index element, std::span<const model::ContactSide> memory) const {
  int side = 0;
  for (const model::ContactSide& known : memory) {
    const auto& across = model_.neighbour[at(element)];
    if (across[0] == known.element || across[1] == known.element || across[2] == known.element) {
      return known.side;
    }
    if (side == 0 && share_corner(element, known.element)) {
      side = known.side;
    }
  }
  return side;
}

void NodeWatch::decide_sides(std::span<const model::ContactSide> memory) {
  for (Watched& w : watched_) {
    if (w.rim) {
      w.side = w.present_side;
    } else if (const model::ContactSide* known = find(memory, w.element)) {
      w.side = known->side;
    } else {
      w.side = inherited_side(w.element, memory);
    }
    if (w.side == 0) {
      w.side = side_of(model_, before_, w.element, closest_on(model_, before_, w.element, before_(node_)));
    }
  }
  // Where a neighbour is closer, its side is what counts: a node that goes round a rim takes the others along.
  for (Watched& w : watched_) {
    for (const Watched& other : watched_) {
      if (other.element == w.closer && other.acts) {
        w.side = other.side;
      }
    }
  }
}

bool NodeWatch::share_corner(Index a, Index b) const {
  const auto& s = model_.triangle[at(a)];
  const auto& t = model_.triangle[at(b)];
  return std::any_of(s.begin(), s.end(), [&](Index n) { return n == t[0] || n == t[1] || n == t[2]; });
}

void NodeWatch::leave_one_of_smooth_neighbours() {
  const auto is_face = [](const Watched& w) { return w.acts && w.closest.feature == physics::Feature::face; };
  for (Watched& w : watched_) {
    for (const Watched& other : watched_) {
      const bool nearer = other.closest.distance2 < w.closest.distance2 ||
                          (other.closest.distance2 == w.closest.distance2 && other.element < w.element);
      // A face that has been beaten itself still beats: what is closest of all decides.
      if (nearer && other.element != w.element && is_face(w) && other.closest.feature == physics::Feature::face &&
          other.side == w.side && dot(other.normal, w.normal) > smooth_cosine &&
          share_corner(other.element, w.element)) {
        w.acts = false;
      }
    }
  }
}

/// Half thicknesses at the closest point, or what the pair had in the reference configuration where that is less.
double NodeWatch::contact_distance(const Watched& w) const {
  const auto& t = model_.triangle[at(w.element)];
  double distance = model_.half_thickness[at(node_)];
  for (std::size_t a = 0; a < 3; ++a) {
    distance += w.closest.weight[a] * model_.half_thickness[at(t[a])];
  }
  const auto& X = model_.reference_position;
  const Vec3d& p = X[at(node_)];
  const Vec3d from = p - X[at(t[0])], side_2 = X[at(t[1])] - X[at(t[0])], side_3 = X[at(t[2])] - X[at(t[0])];
  const double reach = distance + std::sqrt(std::max(dot(side_2, side_2), dot(side_3, side_3)));
  if (dot(from, from) > reach * reach) {
    return distance;
  }
  const double reference2 = physics::closest_point(p, X[at(t[0])], X[at(t[1])], X[at(t[2])]).distance2;
  return reference2 < distance * distance ? std::sqrt(reference2) : distance;
}

void NodeWatch::push(std::vector<ActivePair>& active) const {
  const bool barrier_node = model_.bodies[at(model_.node_body[at(node_)])].barrier;
  for (const Watched& w : watched_) {
    if (!w.acts) {
      continue;
    }
    const double distance = contact_distance(w);
    // On the rim the distance itself is the gap: there is no other side.
    const bool through = !w.rim && w.present_side != w.side;
    const double depth = distance - (through ? -w.distance : w.distance);
    if (!(depth > 0.0)) {
      continue;
    }
    const auto& t = model_.triangle[at(w.element)];
    const double mine = model_.contact_stiffness[at(node_)];
    const double theirs = std::min(
        {model_.contact_stiffness[at(t[0])], model_.contact_stiffness[at(t[1])], model_.contact_stiffness[at(t[2])]});
    const bool barrier_element = model_.bodies[at(body_of_element(model_, w.element))].barrier;
    ActivePair pair;
    pair.stiffness = model_.contact.stiffness >= 0.0 ? model_.contact.stiffness
                     : barrier_node                  ? theirs
                     : barrier_element               ? mine
                                                     : mine * theirs / (mine + theirs);
    // The offset gives the direction while it has one; a node on the very surface is pushed along the normal.
    const double sign = through ? -1.0 : 1.0;
    const bool face = w.closest.feature == physics::Feature::face;
    const Vec3d direction =
        face || !(w.distance > 0.0) ? static_cast<double>(w.side) * w.normal : (sign / w.distance) * w.closest.offset;
    pair.node = node_;
    pair.element = w.element;
    pair.weight = w.closest.weight;
    pair.force = (pair.stiffness * depth) * direction;
    pair.energy = 0.5 * pair.stiffness * depth * depth;
    pair.depth = distance > 0.0 ? depth / distance : HUGE_VAL;
    active.push_back(pair);
  }
}

}  // namespace fexp::contact
