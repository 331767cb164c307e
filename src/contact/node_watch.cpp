// SPDX-License-Identifier: Apache-2.0
#include "contact/node_watch.hpp"

#include <algorithm>
#include <cmath>

#include "contact/near_pairs.hpp"

namespace fexp::contact {

namespace {

/// Neighbours that push in directions less than 60 degrees apart count as one smooth surface: there only the closest
/// pushes, so that a node sliding over an edge never feels two. In sharper valleys both faces push.
constexpr double smooth_cosine = 0.5;
/// Triangles that a node may pass in one step while it is followed.
constexpr int most_hops = 8;

const model::ContactSide* find(std::span<const model::ContactSide> memory, Index element) {
  const auto found = std::lower_bound(memory.begin(), memory.end(), element,
                                      [](const model::ContactSide& s, Index e) { return s.element < e; });
  return found != memory.end() && found->element == element ? &*found : nullptr;
}

bool by_element(const model::ContactSide& a, const model::ContactSide& b) noexcept {
  return a.element != b.element ? a.element < b.element : a.side < b.side;
}
bool same_element(const model::ContactSide& a, const model::ContactSide& b) noexcept { return a.element == b.element; }

}  // namespace

void NodeWatch::look(Index node, CandidateRow candidates, std::span<const model::ContactSide> memory,
                     std::vector<model::ContactSide>& remembered, std::vector<ActivePair>& active) {
  if (!now_.has_surface_at(model_, node)) {
    return;
  }
  node_ = node;
  point_ = now_(node);
  if (still_ && !memory.empty()) {
    recall(memory);
  } else {
    gather(candidates, memory);
    measure(candidates);
    decide_sides(memory);
  }
  find_depths();
  leave_one_of_smooth_neighbours();
  push(memory, active);
  for (const Watched& w : watched_) {
    remembered.push_back({node_, w.element, static_cast<std::int8_t>(w.side), w.drag});
  }
}

/// The pairs as they were left: when nothing has moved since, they push as they did.
void NodeWatch::recall(std::span<const model::ContactSide> memory) {
  watched_.clear();
  for (const model::ContactSide& known : memory) {
    if (now_.has(model_, known.element)) {
      watched_.push_back(measured(known.element));
      watched_.back().side = known.side;
      watched_.back().drag = known.drag;
    }
  }
}

/// Candidates that are due, remembered elements, and those on to which the node has slid from a remembered one that it
/// has come through: there it may be at a depth at which nobody else would look for it.
void NodeWatch::gather(const CandidateRow& candidates, std::span<const model::ContactSide> memory) {
  deep_.clear();
  through_.clear();
  followed_.clear();
  near_.clear();
  for (std::size_t i = candidates.due_from(0); i < candidates.size(); i = candidates.due_from(i + 1)) {
    if (now_.has(model_, candidates.partner(i))) {
      near_.push_back({candidates.partner(i), static_cast<Index>(i)});
    }
  }
  if (memory.empty()) {
    return;
  }
  for (const model::ContactSide& known : memory) {
    if (now_.has(model_, known.element)) {
      near_.push_back({known.element});
      follow(known);
    }
  }
  std::sort(deep_.begin(), deep_.end(), by_element);
  deep_.erase(std::unique(deep_.begin(), deep_.end(), same_element), deep_.end());
  for (const model::ContactSide& deep : deep_) {
    near_.push_back({deep.element});
  }
  // Of those that come twice the candidate is kept.
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) {
    return a.element != b.element ? a.element < b.element : a.candidate > b.candidate;
  });
  const auto same = [](const Near& a, const Near& b) { return a.element == b.element; };
  near_.erase(std::unique(near_.begin(), near_.end(), same), near_.end());
}

/// From an element that the node has come through to the neighbour that is closer now, until none is: there the pair
/// goes on. On the rim of a surface it ends.
void NodeWatch::follow(const model::ContactSide& known) {
  Watched w = measured(known.element);
  followed_.push_back(w);
  if (!w.is_through(known.side)) {
    return;
  }
  for (int hop = 0; hop < most_hops && !w.acts; ++hop) {
    if (!may_touch(model_, node_, w.closer)) {
      through_.push_back(known);
      return;
    }
    w = measured(w.closer);
  }
  if (w.acts && (!w.is_through(known.side) || !could_come_through(w, known.side))) {
    return;
  }
  through_.push_back(known);
  const double deepest = watch_distance(model_, node_, w.element) + depth_limit(w.element);
  if (w.acts && w.distance < deepest) {
    deep_.push_back({node_, w.element, known.side});
  }
}

/// Depth at which a pair is given up [length]: the size of the smaller of node and element.
double NodeWatch::depth_limit(Index element) const {
  double size = model_.node_size[at(node_)];
  for (const Index n : model_.triangle[at(element)]) {
    size = std::min(size, model_.node_size[at(n)]);
  }
  return size;
}

NodeWatch::Watched NodeWatch::measured(Index element) {
  Watched w;
  w.element = element;
  w.closest = closest_on(model_, now_, element, point_);
  w.distance = std::sqrt(w.closest.distance2);
  w.normal = normals_(element);
  w.rim = is_on_rim(model_, now_, element, w.closest.feature);
  w.view = view_of(model_, normals_, element, w.closest);
  w.acts = true;
  double least = w.closest.distance2;
  Index first = element;
  for_each_sharing(model_, now_, element, w.closest.feature, [&](Index other) {
    const double theirs = closest_on(model_, now_, other, point_).distance2;
    if (theirs < least || (theirs == least && other < first)) {
      least = theirs;
      first = other;
      w.acts = false;
      w.closer = other;
    }
  });
  return w;
}

/// Keeps pairs within watch distance, and those that the node has come through and that `follow` has found. Of all
/// elements that share a feature, the closest acts (by squared distance, then number).
void NodeWatch::measure(CandidateRow& candidates) {
  watched_.clear();
  auto followed = followed_.cbegin();  // In ascending order of elements, as these are
  for (const Near& near : near_) {
    const Index element = near.element;
    while (followed != followed_.cend() && followed->element < element) {
      ++followed;
    }
    const bool is_known = followed != followed_.cend() && followed->element == element;
    const double watch = watch_distance(model_, node_, element);
    const double distance2 =
        is_known ? followed->closest.distance2 : closest_on(model_, now_, element, point_).distance2;
    if (distance2 < watch * watch || find(deep_, element) != nullptr) {
      watched_.push_back(is_known ? *followed : measured(element));
    } else if (near.candidate != no_index) {
      candidates.leave_alone(static_cast<std::size_t>(near.candidate),
                             std::sqrt(distance2) * (1.0 - distance_rounding) - watch * (1.0 + distance_rounding));
    }
  }
}

/// Where a node belongs that has come through an element next to this one, those across an edge first; 0 when it has
/// not: then it belongs where it came from.
int NodeWatch::inherited_side(Index element) const {
  int side = 0;
  for (const model::ContactSide& known : through_) {
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

/// How far the node has come in this step against the closest point of the element [length].
Vec3d NodeWatch::way_of(const Watched& w) const {
  const auto& t = model_.triangle[at(w.element)];
  Vec3d way = point_ - before_(node_);
  for (std::size_t a = 0; a < 3; ++a) {
    way -= w.closest.weight[a] * (now_(t[a]) - before_(t[a]));
  }
  return way;
}

/// Whether the node was behind the element before this step, or may have come through it in the step. Otherwise it has
/// gone round an edge: the element was remembered for the sake of a closer neighbour.
bool NodeWatch::could_come_through(const Watched& w, int home) {
  if (w.distance <= 2.0 * norm(way_of(w))) {
    return true;
  }
  const auto closest = closest_on(model_, before_, w.element, before_(node_));
  const View view = view_of(model_, normals_before_, w.element, closest);
  return view.agreed && view.side != home;
}

void NodeWatch::decide_sides(std::span<const model::ContactSide> memory) {
  for (Watched& w : watched_) {
    if (w.rim) {
      w.side = w.view.side;
    } else if (const model::ContactSide* known = find(memory, w.element)) {
      w.side = w.acts && w.is_through(known->side) && !could_come_through(w, known->side) ? w.view.side : known->side;
    } else if (const model::ContactSide* deep = find(deep_, w.element)) {
      w.side = deep->side;
    } else {
      w.side = inherited_side(w.element);
    }
    if (w.side == 0) {
      w.side = view_of(model_, normals_before_, w.element, closest_on(model_, before_, w.element, before_(node_))).side;
    }
  }
  for (Watched& w : watched_) {
    if (w.closer != no_index || !w.is_through(w.side)) {
      continue;
    }
    const bool hidden = std::ranges::any_of(watched_, [&](const Watched& other) {
      return other.closer == no_index && other.is_nearer(w) && !other.is_through(other.side) && hides(other, w);
    });
    if (hidden) {
      w.side = w.view.side;  // What is in front of it has not let the node through
    }
  }
  // Where a neighbour is closer, its side is what counts, and so on to the closest of all: a node that goes round a rim
  // takes all others along. A closer neighbour that is not watched is the node's own element, and until the node stands
  // before the face itself there is nothing to remember. Where the element ends at others, their sides are not its own.
  const auto watched = [&](Index element) {
    const auto found = std::lower_bound(watched_.begin(), watched_.end(), element,
                                        [](const Watched& w, Index wanted) { return w.element < wanted; });
    return found != watched_.end() && found->element == element ? &*found : nullptr;
  };
  for (Watched& w : watched_) {
    if (w.acts || !goes_on(model_, w.element, w.closest.feature, w.closer)) {
      continue;
    }
    const Watched* closest = watched(w.closer);
    if (closest == nullptr) {
      w.side = dot(w.closest.offset, w.normal) < 0.0 ? -1 : 1;
      continue;
    }
    while (closest != nullptr && !closest->acts) {
      const bool same_side = goes_on(model_, closest->element, closest->closest.feature, closest->closer);
      closest = same_side ? watched(closest->closer) : nullptr;
    }
    if (closest != nullptr) {
      // In front of what is closest it has not come through what it sees from behind there: the surface is bent.
      w.side = w.is_through(closest->side) && !closest->is_through(closest->side) ? w.view.side : closest->side;
    }
  }
}

/// Whether a tie holds the node at a corner of the element, or that at the node.
bool NodeWatch::is_joined_with(Index element) const {
  return !model_.ties.empty() && std::ranges::any_of(model_.triangle[at(element)], [this](Index corner) {
    return are_joined(model_, now_, node_, corner);
  });
}

bool NodeWatch::share_corner(Index a, Index b) const {
  const auto& s = model_.triangle[at(a)];
  const auto& t = model_.triangle[at(b)];
  return std::any_of(s.begin(), s.end(), [&](Index n) { return n == t[0] || n == t[1] || n == t[2]; });
}

/// Whether an element is seen through another one: they meet at a sharp fold.
bool NodeWatch::hides(const Watched& other, const Watched& w) const {
  return other.view.agreed && w.view.agreed && other.view.side != w.view.side && share_corner(other.element, w.element);
}

/// Direction of the force on the node. The offset gives it while it has one; a node on the very surface is pushed along
/// the normal.
Vec3d NodeWatch::direction(const Watched& w) {
  if (w.closest.feature == physics::Feature::face || !(w.distance > 0.0)) {
    return static_cast<double>(w.side) * w.normal;
  }
  return ((w.is_through(w.side) ? -1.0 : 1.0) / w.distance) * w.closest.offset;
}

/// Whether the closest points lie on features that have a corner in common.
bool NodeWatch::are_neighbours(const Watched& a, const Watched& b) const {
  const auto &s = model_.triangle[at(a.element)], &t = model_.triangle[at(b.element)];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (s[i] == t[j] && a.closest.weight[i] > physics::feature_tolerance &&
          b.closest.weight[j] > physics::feature_tolerance) {
        return true;
      }
    }
  }
  return false;
}

void NodeWatch::find_depths() {
  for (Watched& w : watched_) {
    if (w.acts && !is_joined_with(w.element)) {
      w.full = full_distance(w);
      w.reach = contact_distance(w, w.full);
      w.depth = w.reach - (w.is_through(w.side) ? -w.distance : w.distance);
    }
  }
}

/// A smooth hollow may have several closest points, on faces, edges and corners. A node that has come through a body is
/// pushed back through what is closest of it, not out of every wall it sees from inside. All that is compared here is
/// the same whichever element stands for an edge or a corner.
void NodeWatch::leave_one_of_smooth_neighbours() {
  const auto both_through = [&](const Watched& a, const Watched& b) {
    return a.side == b.side && a.is_through(a.side) && b.is_through(b.side) &&
           body_of_element(model_, a.element) == body_of_element(model_, b.element);
  };
  for (Watched& w : watched_) {
    for (const Watched& other : watched_) {
      const bool nearer = other.is_nearer(w);
      const bool in_front = !other.is_through(other.side) && !w.is_through(w.side);
      const bool deeper = in_front && other.depth != w.depth ? other.depth > w.depth : nearer;
      // One that has been beaten itself still beats: what is deepest, or closest, of all decides.
      if (w.acts && other.closer == no_index && other.element != w.element &&
          ((nearer && (hides(other, w) || both_through(other, w))) ||
           (deeper && dot(direction(other), direction(w)) > smooth_cosine && are_neighbours(other, w)))) {
        w.acts = false;
      }
    }
  }
}

/// Half thicknesses at the closest point [length].
double NodeWatch::full_distance(const Watched& w) const {
  const auto& t = model_.triangle[at(w.element)];
  double distance = model_.half_thickness[at(node_)];
  for (std::size_t a = 0; a < 3; ++a) {
    distance += w.closest.weight[a] * model_.half_thickness[at(t[a])];
  }
  return distance;
}

/// These, or what the pair had in the reference configuration where that is less.
double NodeWatch::contact_distance(const Watched& w, double full) const {
  const auto& t = model_.triangle[at(w.element)];
  const std::vector<Vec3d>& reference = model_.reference_position;
  const Vec3d& p = reference[at(node_)];
  const Vec3d &a = reference[at(t[0])], &b = reference[at(t[1])], &c = reference[at(t[2])];
  const Vec3d from = p - a, side_2 = b - a, side_3 = c - a;
  const double reach = full + std::sqrt(std::max(dot(side_2, side_2), dot(side_3, side_3)));
  if (dot(from, from) > reach * reach) {
    return full;
  }
  const double reference2 = physics::closest_point(p, a, b, c).distance2;
  return reference2 < full * full ? std::sqrt(reference2) : full;
}

/// Series of the node and the corners, these by their weights: what barriers give way is nothing. Elements that share
/// an edge or a corner give the same there, and no corner gets more than its own stiffness allows.
double NodeWatch::stiffness(const Watched& w, const model::ContactLaw& law) const {
  if (law.stiffness >= 0.0) {
    return law.stiffness;
  }
  double compliance = 0.0;
  if (!model_.bodies[at(model_.node_body[at(node_)])].barrier) {
    compliance = 1.0 / model_.contact_stiffness[at(node_)];
  }
  if (!model_.bodies[at(body_of_element(model_, w.element))].barrier) {
    const auto& t = model_.triangle[at(w.element)];
    for (std::size_t a = 0; a < 3; ++a) {
      compliance += w.closest.weight[a] / model_.contact_stiffness[at(t[a])];
    }
  }
  return law.scale / compliance;
}

const model::ContactLaw& NodeWatch::law_of(const Watched& w) const {
  return laws_.of(model_.node_body[at(node_)], body_of_element(model_, w.element));
}

void NodeWatch::push(std::span<const model::ContactSide> memory, std::vector<ActivePair>& active) {
  const bool drags = laws_.drags && !still_;
  handed_on_.assign(drags ? memory.size() : 0, 0);
  for (Watched& w : watched_) {
    if (!w.acts) {
      continue;
    }
    if (!(w.depth > 0.0)) {
      continue;
    }
    ActivePair pair;
    const model::ContactLaw& law = law_of(w);
    const double stiff = stiffness(w, law);
    const physics::Penalty penalty = physics::penalty_of(stiff, law.hardening, w.depth, w.full);
    pair.stiffness = penalty.stiffness;
    pair.node = node_;
    pair.element = w.element;
    pair.weight = w.closest.weight;
    const Vec3d normal = direction(w);
    pair.force = penalty.force * normal;
    pair.energy = penalty.energy;
    pair.depth = w.reach > 0.0 ? w.depth / w.reach : HUGE_VAL;
    if (law.drag.acts()) {
      if (drags) {
        drag(w, law.drag, stiff, memory, pair);
      } else {
        pair.force += w.drag;
        pair.energy += physics::stored_energy(w.drag, normal, stiff);
      }
      pair.stiffness *= law.drag.frequency2_factor();
    }
    active.push_back(pair);
  }
  if (drags) {
    part(memory, active);
  }
}

/// The drag of the step before that goes on at an element: its own, or that of an element next to it, which the node
/// has left.
const model::ContactSide* NodeWatch::drag_before(Index element, std::span<const model::ContactSide> memory) const {
  const model::ContactSide* own = find(memory, element);
  if (own != nullptr && own->drag != Vec3d{}) {
    return own;
  }
  const auto still_acts = [this](Index other) {
    return std::any_of(watched_.begin(), watched_.end(),
                       [other](const Watched& w) { return w.element == other && w.acts; });
  };
  for (std::size_t i = 0; i < memory.size(); ++i) {
    if (handed_on_[i] == 0 && memory[i].drag != Vec3d{} && share_corner(memory[i].element, element) &&
        !still_acts(memory[i].element)) {
      return &memory[i];
    }
  }
  return nullptr;
}

void NodeWatch::drag(Watched& w, const physics::DragLaw& law, double stiffness,
                     std::span<const model::ContactSide> memory, ActivePair& pair) {
  const model::ContactSide* known = drag_before(w.element, memory);
  if (known != nullptr) {
    handed_on_[static_cast<std::size_t>(known - memory.data())] = 1;
  }
  const auto inverse_mass = [this](Index n) {
    return model_.bodies[at(model_.node_body[at(n)])].barrier ? 0.0 : 1.0 / model_.mass[at(n)];
  };
  physics::DragPair moving;
  moving.normal = direction(w);
  moving.normal_force = dot(pair.force, moving.normal);
  moving.stiffness = stiffness;
  moving.inverse_mass = inverse_mass(node_);
  const auto& t = model_.triangle[at(w.element)];
  for (std::size_t a = 0; a < 3; ++a) {
    moving.inverse_mass += w.closest.weight[a] * inverse_mass(t[a]);
  }
  moving.way = way_of(w);
  moving.dt = before_.back - now_.back;
  const physics::Drag drag = physics::drag_of(law, moving, known != nullptr ? known->drag : Vec3d{});
  w.drag = drag.force;
  pair.force += drag.force;
  pair.energy += drag.stored;
  pair.dissipated = drag.dissipated;
}

/// What pairs that push no more had stored is lost.
void NodeWatch::part(std::span<const model::ContactSide> memory, std::vector<ActivePair>& active) {
  for (std::size_t i = 0; i < memory.size(); ++i) {
    if (handed_on_[i] != 0 || memory[i].drag == Vec3d{}) {
      continue;
    }
    const Watched w = measured(memory[i].element);
    ActivePair parted;
    parted.node = node_;
    parted.element = w.element;
    parted.dissipated = physics::stored_energy(memory[i].drag, direction(w), stiffness(w, law_of(w))) -
                        0.5 * dot(memory[i].drag, way_of(w));
    active.push_back(parted);
  }
}

}  // namespace fexp::contact
