// SPDX-License-Identifier: Apache-2.0
#include "contact/island_contact.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::contact {

namespace {

/// The skin as a part of the mean element size: larger means fewer searches and more candidates.
constexpr double skin_part = 0.4;
/// The same of the margin: larger means that the tree of blocks is asked more seldom, and finds more.
constexpr double margin_part = 1.0;
/// Partners are looked for again when this part of the margin is used up.
constexpr double worn_part = 0.8;
/// By how much more than its velocity says a step moves a node, as a part of its coordinates.
constexpr double rounding = 1.0e-15;

template <class Side>
std::vector<Side> all_of(const std::vector<std::vector<Side>>& sides, const std::vector<Index>& bodies) {
  std::vector<Side> all;
  for (const Index body : bodies) {
    all.insert(all.end(), sides[at(body)].begin(), sides[at(body)].end());
  }
  return all;
}

Positions positions(const model::Model& model, const model::State& state, double back, bool still) noexcept {
  return {state.motion.data(), back, model.can_fail ? state.layers.data() : nullptr, still,
          model.ties.can_break ? state.ties.data() : nullptr};
}

}  // namespace

Index IslandContact::owner(const model::Model& model, Index node, Index element) {
  const Index body = model.node_body[at(node)];
  return model.bodies[at(body)].barrier ? body_of_element(model, element) : body;
}

void IslandContact::assign(const model::Model& model, std::span<const Index> bodies, std::span<const Index> barriers,
                           const model::State& state) {
  bodies_.assign(bodies.begin(), bodies.end());
  nodes_.assign({});
  edges_.assign({});
  report_ = {};
  searched_ = false;
  books_.assign(state, bodies);
  enabled_ = model.contact.enabled && !bodies.empty() &&
             (bodies.size() + barriers.size() > 1 || model.can_touch(bodies[0], bodies[0]));
  with_edges_ = enabled_ && model.contact.edges;
  if (!enabled_) {
    return;
  }
  std::vector<Index> all(bodies.begin(), bodies.end());
  all.insert(all.end(), barriers.begin(), barriers.end());
  std::sort(all.begin(), all.end());
  blocks_.assign(model, all);
  node_search_.assign(model, all);
  double size = 0.0;
  for (const Index n : node_search_.nodes()) {
    size += model.node_size[at(n)];
  }
  size /= static_cast<double>(node_search_.node_count());
  skin_ = skin_part * size;
  margin_ = margin_part * size;
  nodes_.assign(all_of(state.sides, bodies_));
  if (with_edges_) {
    edge_search_.assign(model, all);
    edges_.assign(all_of(state.edge_sides, bodies_));
  }
}

void IslandContact::store_sides(const model::Model& model, model::State& state) const {
  for (const Index body : bodies_) {
    state.sides[at(body)].clear();
    state.edge_sides[at(body)].clear();
  }
  for (const model::ContactSide& side : nodes_.all_sides()) {
    state.sides[at(owner(model, side.node, side.element))].push_back(side);
  }
  if (with_edges_) {
    for (const model::EdgeSide& side : edges_.all_sides()) {
      state.edge_sides[at(owner(model, ends_of(model, side.first)[0], side.second / 3))].push_back(side);
    }
  }
}

void IslandContact::advance(const model::Model& model, const model::State& state, double largest_way) {
  if (!enabled_ || !searched_) {
    return;
  }
  const double way = 2.0 * (largest_way + rounded_way_);
  way_ += way;
  travelled_ += way;
  if (way_ > most_way_) {
    search_worn(model, positions(model, state, 0.0, false));
  }
}

void IslandContact::search_all(const model::Model& model, const Positions& x) {
  blocks_.search(model, x, skin_ + margin_);
  wear_.begin(blocks_, x);
  search(model, x);
  searched_ = true;
}

/// Searches again where blocks have moved against each other, which is not where the island flies as a whole.
void IslandContact::search_worn(const model::Model& model, const Positions& x) {
  wear_.add(blocks_, x, rounded_way_);
  moved_ += wear_.last();
  if (wear_.whole() > worn_part * margin_) {
    blocks_.search(model, x, skin_ + margin_);
    wear_.take_over(blocks_);
  }
  search(model, x);
}

void IslandContact::search(const model::Model& model, const Positions& x) {
  const std::vector<Index> due = wear_.take_due(blocks_, skin_);
  rounded_way_ = rounding * wear_.farthest();
  way_ = 0.0;
  most_way_ = std::min(skin_ - wear_.most_used(), margin_ - wear_.whole());
  if (due.empty()) {
    return;
  }
  node_search_.search(model, blocks_, wear_, due, x, skin_);
  nodes_.renew([&](std::span<const Index> remembered, CandidateRows& found) {
    node_search_.list(blocks_, wear_, remembered, found);
  });
  moved_ = 0.0;
  travelled_ = 0.0;
  ++report_.searches;
  report_.candidates = nodes_.candidate_count();
  if (with_edges_) {
    edge_search_.search(blocks_, wear_, due, x, skin_);
    edges_.renew([&](std::span<const Index> remembered, CandidateRows& found) {
      edge_search_.list(blocks_, wear_, remembered, found);
    });
    report_.candidates += edges_.candidate_count();
  }
}

void IslandContact::look(const model::Model& model, const Positions& now, const Positions& before) {
  if (!searched_) {
    search_all(model, now);
  }
  if (with_edges_) {
    edges_.look(moved_ + way_, travelled_, [&] { return EdgeWatch(model, now, before); });
  }
  nodes_.look(moved_ + way_, travelled_, [&] { return NodeWatch(model, now, before); });
}

void IslandContact::recall(const model::Model& model, const model::State& state) {
  if (enabled_) {
    const Positions now = positions(model, state, 0.0, true);
    look(model, now, now);
  }
}

ContactReport IslandContact::evaluate(const model::Model& model, const model::State& state, double dt,
                                      NodeContact& nodes, BodyContact* bodies) {
  if (!enabled_) {
    return report_;
  }
  const bool still = dt == 0.0;
  const Positions now = positions(model, state, 0.0, still), before = positions(model, state, dt, still);
  look(model, now, before);
  books_.open(still);
  report_.active_pairs = 0;
  report_.deepest = 0.0;
  report_.deepest_node = no_index;
  report_.deepest_element = no_index;
  nodes_.for_each_active([&](const ActivePair& pair) { add(model, now, pair, nodes, bodies); });
  if (with_edges_) {
    edges_.for_each_active([&](const ActiveEdges& pair) { add(model, now, pair, nodes, bodies); });
  }
  books_.close();
  if (!still) {
    book_half_work(model, state, dt, bodies);
  }
  find_stiffest(model, nodes);
  return report_;
}

/// The bound of contact's frequency, and the first pair that has it.
void IslandContact::find_stiffest(const model::Model& model, const NodeContact& nodes) {
  double largest = 0.0;
  const auto exceeds = [&](Index n) {
    const double share = 2.0 * nodes.stiffness[at(n)] / model.mass[at(n)];
    const bool more = largest < share;
    largest = more ? share : largest;
    return more;
  };
  report_.stiffest_node = no_index;
  report_.stiffest_element = no_index;
  nodes_.for_each_active([&](const ActivePair& pair) {
    const auto& t = model.triangle[at(pair.element)];
    // All are looked at, whichever exceeds.
    const std::array<bool, 4> more{exceeds(pair.node), exceeds(t[0]), exceeds(t[1]), exceeds(t[2])};
    if (more[0] || more[1] || more[2] || more[3]) {
      report_.stiffest_node = pair.node;
      report_.stiffest_element = pair.element;
    }
  });
  if (with_edges_) {
    edges_.for_each_active([&](const ActiveEdges& pair) {
      const std::array<Index, 2> first = ends_of(model, pair.first), second = ends_of(model, pair.second);
      const std::array<bool, 4> more{exceeds(first[0]), exceeds(first[1]), exceeds(second[0]), exceeds(second[1])};
      if (more[0] || more[1] || more[2] || more[3]) {
        report_.stiffest_node = second[0];
        report_.stiffest_element = pair.first / 3;
      }
    });
  }
  report_.max_stiffness_over_mass = largest;
}

/// Barriers do not move.
void IslandContact::book_half_work(const model::Model& model, const model::State& state, double dt,
                                   BodyContact* bodies) {
  const double half_dt = 0.5 * dt;
  const model::NodeMotion* const motion = state.motion.data();
  const auto power = [motion](const Vec3d& force, Index n) { return dot(force, motion[n].velocity); };
  const auto book = [&](Index a, Index b, double on_a, double on_b) {
    books_.add_work(model, a, b, half_dt * on_a, half_dt * on_b);
    if (!model.bodies[at(a)].barrier) {
      bodies[a].work += half_dt * on_a;
    }
    if (!model.bodies[at(b)].barrier) {
      bodies[b].work += half_dt * on_b;
    }
  };
  nodes_.for_each_active([&](const ActivePair& pair) {
    const auto& t = model.triangle[at(pair.element)];
    const Vec3d surface = pair.weight[0] * motion[t[0]].velocity + pair.weight[1] * motion[t[1]].velocity +
                          pair.weight[2] * motion[t[2]].velocity;
    book(model.node_body[at(pair.node)], body_of_element(model, pair.element), power(pair.force, pair.node),
         -dot(pair.force, surface));
  });
  if (with_edges_) {
    edges_.for_each_active([&](const ActiveEdges& pair) {
      const std::array<Index, 2> first = ends_of(model, pair.first), second = ends_of(model, pair.second);
      const Index a = model.node_body[at(first[0])], b = model.node_body[at(second[0])];
      double on_a = power(pair.force[0], first[0]) + power(pair.force[1], first[1]);
      double on_b = power(pair.force[2], second[0]) + power(pair.force[3], second[1]);
      for (std::size_t i = 0; i < 2 && pair.corner[i] != no_index; ++i) {
        (model.node_body[at(pair.corner[i])] == a ? on_a : on_b) += power(pair.corner_force[i], pair.corner[i]);
      }
      book(a, b, on_a, on_b);
    });
  }
}

void IslandContact::count(double stiffness, double depth, Index node, Index element) {
  if (stiffness > 0.0) {
    ++report_.active_pairs;
  }
  if (depth > report_.deepest) {
    report_.deepest = depth;
    report_.deepest_node = node;
    report_.deepest_element = element;
  }
}

/// Adds a pair's force to its node and the opposite to the corners, in equal and opposite parts. Pairs come in
/// ascending order, so the sums are the same whatever thread found them.
void IslandContact::add(const model::Model& model, const Positions& x, const ActivePair& pair, NodeContact& nodes,
                        BodyContact* bodies) {
  count(pair.stiffness, pair.depth, pair.node, pair.element);
  const bool barrier_node = model.bodies[at(model.node_body[at(pair.node)])].barrier;
  const bool barrier_element = model.bodies[at(body_of_element(model, pair.element))].barrier;
  BodyContact& body = bodies[owner(model, pair.node, pair.element)];
  body.energy += pair.energy;
  body.dissipated += pair.dissipated;
  books_.add(model, model.node_body[at(pair.node)], body_of_element(model, pair.element), pair.energy, pair.dissipated);
  if (!barrier_node) {
    nodes.force[at(pair.node)] += pair.force;
    nodes.stiffness[at(pair.node)] += pair.stiffness;
  }
  if (barrier_element) {
    body.barrier_force += pair.force;
    body.barrier_moment += cross(x(pair.node), pair.force);
    return;
  }
  const auto& t = model.triangle[at(pair.element)];
  const Vec3d second = pair.weight[1] * pair.force, third = pair.weight[2] * pair.force;
  const std::array<Vec3d, 3> share{pair.force - (second + third), second, third};
  for (std::size_t a = 0; a < 3; ++a) {
    nodes.force[at(t[a])] -= share[a];
    nodes.stiffness[at(t[a])] += pair.weight[a] * pair.stiffness;
    if (barrier_node) {
      body.barrier_force -= share[a];
      body.barrier_moment -= cross(x(t[a]), share[a]);
    }
  }
}

/// The same for a pair of edges.
void IslandContact::add(const model::Model& model, const Positions& x, const ActiveEdges& pair, NodeContact& nodes,
                        BodyContact* bodies) {
  const std::array<Index, 2> first = ends_of(model, pair.first), second = ends_of(model, pair.second);
  count(pair.stiffness, pair.depth, second[0], pair.first / 3);
  BodyContact& body = bodies[owner(model, first[0], pair.second / 3)];
  body.energy += pair.energy;
  body.dissipated += pair.dissipated;
  books_.add(model, model.node_body[at(first[0])], model.node_body[at(second[0])], pair.energy, pair.dissipated);
  const auto is_barrier = [&](Index n) { return model.bodies[at(model.node_body[at(n)])].barrier; };
  const bool with_barrier = is_barrier(first[0]) || is_barrier(second[0]);
  const auto act = [&](Index n, const Vec3d& force, double stiffness) {
    if (is_barrier(n)) {
      return;
    }
    nodes.force[at(n)] += force;
    nodes.stiffness[at(n)] += stiffness;
    if (with_barrier) {
      body.barrier_force += force;
      body.barrier_moment += cross(x(n), force);
    }
  };
  act(first[0], pair.force[0], (1.0 - pair.at_first) * pair.stiffness);
  act(first[1], pair.force[1], pair.at_first * pair.stiffness);
  act(second[0], pair.force[2], (1.0 - pair.at_second) * pair.stiffness);
  act(second[1], pair.force[3], pair.at_second * pair.stiffness);
  for (std::size_t i = 0; i < 2 && pair.corner[i] != no_index; ++i) {
    act(pair.corner[i], pair.corner_force[i], pair.corner_stiffness[i]);
  }
}

}  // namespace fexp::contact
