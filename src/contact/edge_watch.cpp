// SPDX-License-Identifier: Apache-2.0
#include "contact/edge_watch.hpp"

#include <algorithm>
#include <cmath>

#include "contact/near_pairs.hpp"

namespace fexp::contact {

namespace {

double limited(double a) noexcept { return a < 0.0 ? 0.0 : a > 1.0 ? 1.0 : a; }

Vec3d between(const Vec3d& a, const Vec3d& b, double part) noexcept { return (1.0 - part) * a + part * b; }

/// Adds a force on a point of the second edge and takes it from one of the first.
void add_force(double at_first, double at_second, const Vec3d& force, std::array<Vec3d, 4>& ends) noexcept {
  const Vec3d of_first = at_first * force, of_second = at_second * force;
  ends[0] -= force - of_first;
  ends[1] -= of_first;
  ends[2] += force - of_second;
  ends[3] += of_second;
}

/// Of a pair whose ends give way by `compliance` in series [force/length].
double pair_stiffness(const model::ContactLaw& law, double compliance) noexcept {
  return law.stiffness >= 0.0 ? law.stiffness : law.scale / compliance;
}

}  // namespace

EdgeWatch::Pair EdgeWatch::pair_at(const Positions& x, Index first, Index second) const {
  const std::array<Index, 2> a = ends_of(model_, first), b = ends_of(model_, second);
  Pair p;
  p.first = first;
  p.second = second;
  p.node = {a[0], a[1], b[0], b[1]};
  const double first_half = edge_half_thickness(model_, a), second_half = edge_half_thickness(model_, b);
  p.thickest = first_half + second_half;
  p.reach = (first_half + edge_margin(model_, a)) + (second_half + edge_margin(model_, b));
  p.lines = physics::closest_on_lines(x(a[0]), x(a[1]), x(b[0]), x(b[1]));
  constexpr double least = physics::feature_tolerance, most = 1.0 - physics::feature_tolerance;
  p.inside = p.lines.sine2 > physics::parallel_sine2 && p.lines.first > least && p.lines.first < most &&
             p.lines.second > least && p.lines.second < most;
  return p;
}

/// Whether an element at the edge is left.
bool EdgeWatch::is_there(Index edge) const {
  bool there = now_.has(model_, edge / 3);
  if (!there) {
    model::for_each_at_edge(model_, edge, [&](Index other) { there = there || now_.has(model_, other); });
  }
  return there;
}

/// How far the second edge has come in this step against the first one where they are closest [length].
Vec3d EdgeWatch::way_of(const Pair& p) const {
  const auto way = [&](std::size_t end) { return now_(p.node[end]) - before_(p.node[end]); };
  return between(way(2), way(3), p.lines.second) - between(way(0), way(1), p.lines.first);
}

/// A pair that is remembered stays on its side. A new one belongs where it was before the step if it has come through
/// in this step.
int EdgeWatch::side_of(const Pair& p, const model::EdgeSide* known) const {
  if (known != nullptr) {
    return known->side;
  }
  const Vec3d way = way_of(p);
  if (p.lines.gap * p.lines.gap <= 4.0 * dot(way, way)) {
    const Pair old = pair_at(before_, p.first, p.second);
    if (old.inside) {
      return old.side();
    }
  }
  return p.side();
}

/// `corner`: the nodes that Sharpness::corner counts.
physics::Sharpness EdgeWatch::sharpness_of(const Pair& p, int side, Corners& corner) const {
  static_assert(physics::most_at_edge >= model::most_at_edge);
  physics::CrossingEdges edges;
  for (std::size_t end = 0; end < 4; ++end) {
    edges.end[end] = now_(p.node[end]);
  }
  for (std::size_t which = 0; which < 2; ++which) {
    const Index edge = which == 0 ? p.first : p.second;
    const auto take = [&](Index element) {
      if (!now_.has(model_, element)) {
        return;
      }
      for (const Index n : model_.triangle[at(element)]) {
        if (n != p.node[2 * which] && n != p.node[2 * which + 1]) {
          const auto triangle = static_cast<std::size_t>(edges.triangles[which]);
          corner[physics::most_at_edge * which + triangle] = n;
          edges.corner[which][triangle] = now_(n);
        }
      }
      ++edges.triangles[which];
    };
    take(edge / 3);
    model::for_each_at_edge(model_, edge, take);
  }
  return physics::sharpness_of(edges, p.lines, side);
}

/// What the edges had between them in the reference configuration, as far as that may matter [length].
double EdgeWatch::most_distance(const Pair& p) const {
  const std::vector<Vec3d>& x = model_.reference_position;
  const Vec3d &a0 = x[at(p.node[0])], &a1 = x[at(p.node[1])], &b0 = x[at(p.node[2])], &b1 = x[at(p.node[3])];
  const Vec3d from = b0 - a0;
  const double reach = p.reach + norm(a1 - a0) + norm(b1 - b0);
  return dot(from, from) > reach * reach ? p.reach : std::sqrt(physics::edge_distance2(a0, a1, b0, b1));
}

EdgeWatch::Place EdgeWatch::place_at(const Pair& p, double first, double second, double most_distance) const {
  Place place;
  place.first = first;
  place.second = second;
  const std::array<double, 4> weight{1.0 - first, first, 1.0 - second, second};
  for (std::size_t end = 0; end < 4; ++end) {
    const std::size_t n = at(p.node[end]);
    place.full += weight[end] * model_.half_thickness[n];
    // Barriers do not give way.
    if (!model_.bodies[at(model_.node_body[n])].barrier) {
      place.compliance += weight[end] / model_.contact_stiffness[n];
      place.inverse_mass += weight[end] / model_.mass[n];
    }
  }
  place.distance = most_distance < place.full ? most_distance : place.full;
  return place;
}

/// Whether a tie joins an end of one edge with one of the other.
bool EdgeWatch::have_joined_ends(const Pair& p) const {
  const auto joined = [&](std::size_t a, std::size_t b) { return are_joined(model_, now_, p.node[a], p.node[b]); };
  return !model_.ties.empty() && (joined(0, 2) || joined(0, 3) || joined(1, 2) || joined(1, 3));
}

const model::ContactLaw& EdgeWatch::law_of(const Pair& p) const {
  return model_.contact_laws.of(model_.node_body[at(p.node[0])], model_.node_body[at(p.node[2])]);
}

/// How far the ends must move relative to each other before edges that are not near can be [length]. What costs least
/// is enough where it says that they are apart.
double EdgeWatch::motion_before(const Pair& p) const {
  const double reach = p.reach * (1.0 + distance_rounding);
  const auto beyond_reach = [reach](double distance) { return distance * (1.0 - distance_rounding) - reach; };
  if (p.lines.sine2 > physics::parallel_sine2 && beyond_reach(std::abs(p.lines.gap)) > 0.0) {
    return beyond_reach(std::abs(p.lines.gap));
  }
  const Vec3d a0 = now_(p.node[0]), a1 = now_(p.node[1]), b0 = now_(p.node[2]), b1 = now_(p.node[3]);
  const double apart = beyond_reach(std::sqrt(physics::edge_distance2(a0, a1, b0, b1, p.lines)));
  return apart > 0.0 ? apart
                     : (1.0 - distance_rounding) *
                           physics::motion_before_crossing(a0, a1, b0, b1, p.lines, physics::parallel_sine2);
}

void EdgeWatch::look(Index first, CandidateRow candidates, std::span<const model::EdgeSide> memory,
                     std::vector<model::EdgeSide>& remembered, std::vector<ActiveEdges>& active) const {
  if (!is_there(first)) {
    return;
  }
  // As they were left: when nothing has moved since, pairs push as they did.
  std::size_t i = still_ && !memory.empty() ? candidates.size() : candidates.due_from(0);
  auto known = memory.begin();
  while (known != memory.end() || i != candidates.size()) {
    const bool is_known = known != memory.end() && (i == candidates.size() || known->second <= candidates.partner(i));
    const Index next = is_known ? known->second : candidates.partner(i);
    const bool is_candidate = i != candidates.size() && candidates.partner(i) == next;
    if (is_there(next)) {
      const Pair pair = pair_at(now_, first, next);
      watch(pair, is_known ? &*known : nullptr, remembered, active);
      if (is_candidate && !pair.is_near()) {
        candidates.leave_alone(i, motion_before(pair));
      }
    }
    i = is_candidate ? candidates.due_from(i + 1) : i;
    known += is_known ? 1 : 0;
  }
}

void EdgeWatch::watch(const Pair& p, const model::EdgeSide* known, std::vector<model::EdgeSide>& remembered,
                      std::vector<ActiveEdges>& active) const {
  const bool near = p.is_near();
  const Vec3d drag_before = known != nullptr ? known->drag : Vec3d{};
  if (near) {
    remembered.push_back({p.first, p.second, static_cast<std::int8_t>(side_of(p, known)), {}});
    push(remembered.back(), p, drag_before, active);
  }
  if (drag_before != Vec3d{} && !still_ && (!near || remembered.back().drag == Vec3d{})) {
    part(p, drag_before, active);
  }
}

/// What a pair had stored that pushes no more is lost.
void EdgeWatch::part(Pair p, const Vec3d& drag_before, std::vector<ActiveEdges>& active) const {
  p.lines.first = limited(p.lines.first);
  p.lines.second = limited(p.lines.second);
  ActiveEdges parted;
  parted.first = p.first;
  parted.second = p.second;
  const Vec3d normal = p.lines.sine2 > 0.0 ? (1.0 / norm(p.lines.normal)) * p.lines.normal : Vec3d{};
  const double stiff = pair_stiffness(law_of(p), place_at(p, p.lines.first, p.lines.second, HUGE_VAL).compliance);
  parted.dissipated = physics::stored_energy(drag_before, normal, stiff) - 0.5 * dot(drag_before, way_of(p));
  active.push_back(parted);
}

/// Depth of edges at a height over each other, along the normal in which they belong, or of an end that is `distance`
/// away from the other edge. Edges that are through each other are the deeper the farther they are, at first; then less
/// and less, so that no energy is lost with a pair that is given up. An end counts as deep as they are, less by what it
/// is farther away.
EdgeWatch::Depth EdgeWatch::depth_at(double contact_distance, double distance, double height, double reach) {
  if (!(height < 0.0)) {
    return {contact_distance - distance, 0.0, 1.0};
  }
  const double beyond = -height, part = beyond / reach, left = 1.0 - part * part;
  const double kept = left * left, slope = -4.0 * part * left / reach;
  const double plain = contact_distance + 2.0 * beyond - distance;
  return {plain * kept, -(2.0 * kept + plain * slope), kept};
}

void EdgeWatch::push(model::EdgeSide& known, const Pair& p, const Vec3d& drag_before,
                     std::vector<ActiveEdges>& active) const {
  const double height = known.side * p.lines.gap;
  if (height >= p.thickest * (1.0 + distance_rounding)) {
    return;
  }
  const double most = most_distance(p);
  const Place place = place_at(p, p.lines.first, p.lines.second, most);
  const Depth depth = depth_at(place.distance, std::abs(height), height, p.reach);
  if (!(depth.value > 0.0) || have_joined_ends(p)) {
    return;
  }
  Corners corner{};  // Those that are counted are set
  const physics::Sharpness sharpness = sharpness_of(p, known.side, corner);
  if (!(sharpness.part > 0.0)) {
    return;
  }
  const Vec3d normal = (known.side / norm(p.lines.normal)) * p.lines.normal;
  const model::ContactLaw& law = law_of(p);
  const double stiff = pair_stiffness(law, place.compliance), part = sharpness.part;
  const physics::Penalty penalty = physics::penalty_of(stiff, law.hardening, depth.value, place.full);
  ActiveEdges push;
  push.first = p.first;
  push.second = p.second;
  push.at_first = place.first;
  push.at_second = place.second;
  push.energy = penalty.energy;
  // The distance grows with the height before the edges are through, and against it behind that.
  const double by_height = depth.by_height + (height < 0.0 ? depth.by_nearness : -depth.by_nearness);
  add_force(place.first, place.second, (-part * penalty.force * by_height) * normal, push.force);
  leave_to_ends(p, law, most, height, part * normal, push);
  if (!(push.energy > 0.0)) {
    return;
  }
  push.stiffness = part * penalty.stiffness;
  if (part < 1.0) {
    double steepest = 0.0;
    for (std::size_t end = 0; end < 4; ++end) {
      push.force[end] -= push.energy * sharpness.end[end];
      steepest = std::max(steepest, norm(sharpness.end[end]));
    }
    push.stiffness += 4.0 * penalty.force * steepest;
    for (std::size_t i = 0; i < 2; ++i) {
      if (sharpness.corner[i] >= 0) {
        push.corner[i] = corner[static_cast<std::size_t>(sharpness.corner[i])];
        push.corner_force[i] = -push.energy * sharpness.by_corner[i];
        push.corner_stiffness[i] = 2.0 * penalty.force * norm(sharpness.by_corner[i]);
      }
    }
  }
  push.energy *= part;
  push.depth = place.distance > 0.0 ? (place.distance - height) / place.distance : HUGE_VAL;
  if (law.drag.acts()) {
    drag(known, p, law.drag, place, normal, part * stiff, drag_before, push);
    push.stiffness *= law.drag.frequency2_factor();
  }
  active.push_back(push);
}

/// Takes off the energy, for a sharpness of 1, and the force of that end which pushes most against the other edge.
/// `normal`: times the sharpness.
void EdgeWatch::leave_to_ends(const Pair& p, const model::ContactLaw& law, double most_distance, double height,
                              const Vec3d& normal, ActiveEdges& push) const {
  const double part = norm(normal), reach = p.reach;
  double most = 0.0;
  Vec3d at_end, at_crossing;
  Place at_most;
  for (std::size_t end = 0; end < 4; ++end) {
    const bool of_first = end < 2;
    const std::size_t other = of_first ? 2 : 0;
    const Vec3d point = now_(p.node[end]), begin = now_(p.node[other]);
    const Vec3d along = now_(p.node[other + 1]) - begin, from = point - begin;
    const double foot = limited(dot(from, along) / dot(along, along)), own = static_cast<double>(end % 2);
    const Place place = of_first ? place_at(p, own, foot, most_distance) : place_at(p, foot, own, most_distance);
    const Vec3d offset = from - foot * along;
    const double distance = norm(offset);
    const Depth depth = depth_at(place.distance, distance, height, reach);
    if (!(depth.value > 0.0) || !(distance > 0.0)) {
      continue;
    }
    const physics::Penalty penalty =
        physics::penalty_of(pair_stiffness(law, place.compliance), law.hardening, depth.value, place.full);
    if (penalty.energy > most) {
      most = penalty.energy;
      at_most = place;
      at_end = ((of_first ? part : -part) * penalty.force * depth.by_nearness / distance) * offset;
      at_crossing = (penalty.force * depth.by_height) * normal;
    }
  }
  if (most > 0.0) {
    push.energy -= most;
    add_force(at_most.first, at_most.second, at_end, push.force);
    add_force(push.at_first, push.at_second, at_crossing, push.force);
  }
}

void EdgeWatch::drag(model::EdgeSide& known, const Pair& p, const physics::DragLaw& law, const Place& place,
                     const Vec3d& normal, double stiffness, const Vec3d& drag_before, ActiveEdges& push) const {
  if (still_) {
    known.drag = drag_before;
    push.energy += physics::stored_energy(known.drag, normal, stiffness);
  } else {
    const double pressed = dot(push.force[2] + push.force[3], normal);
    const physics::Drag drag = physics::drag_of(
        law,
        {normal, pressed > 0.0 ? pressed : 0.0, stiffness, place.inverse_mass, way_of(p), before_.back - now_.back},
        drag_before);
    known.drag = drag.force;
    push.energy += drag.stored;
    push.dissipated = drag.dissipated;
  }
  add_force(place.first, place.second, known.drag, push.force);
}

}  // namespace fexp::contact
