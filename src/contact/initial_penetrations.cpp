// SPDX-License-Identifier: Apache-2.0
#include "contact/initial_penetrations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "contact/surface.hpp"
#include "contact/whole_search.hpp"
#include "parallel/parallel.hpp"
#include "physics/closest_lines.hpp"
#include "physics/closest_point.hpp"
#include "physics/crossing_edges.hpp"

namespace fexp::contact {

namespace {

/// Shells that just touch do not penetrate, whatever rounding makes of their distance.
constexpr double touching_part = 0.999;
/// Ways along the mesh up to this part of contact distance are short: surfaces that enclose more than 37 degrees are
/// near each other by them.
constexpr double short_way_part = 3.0;
/// Ends of an edge that are nearer to an element's plane than this part of the edge lie in it.
constexpr double in_plane_part = 1.0e-6;
constexpr Index items_per_piece = 512;

/// Nodes to which the mesh leads from some others on a short way.
class NearbyNodes {
 public:
  NearbyNodes(const model::Model& model, std::span<const Index> from, double reach) {
    std::vector<std::pair<double, Index>> open;  // A heap, the nearest on top
    const auto add = [&](Index node, double way) {
      const auto [known, is_new] = way_.try_emplace(node, way);
      if (way > reach || (!is_new && !(way < known->second))) {
        return;
      }
      known->second = way;
      open.emplace_back(way, node);
      std::push_heap(open.begin(), open.end(), std::greater<>());
    };
    for (const Index node : from) {
      add(node, 0.0);
    }
    while (!open.empty()) {
      std::pop_heap(open.begin(), open.end(), std::greater<>());
      const auto [way, node] = open.back();
      open.pop_back();
      if (way > way_.at(node)) {
        continue;
      }
      for (Index c = model.corner_start[at(node)]; c < model.corner_start[at(node) + 1]; ++c) {
        for (const Index other : model.triangle[at(model.corner[at(c)] / 3)]) {
          if (other != node) {
            add(other, way + norm(model.reference_position[at(other)] - model.reference_position[at(node)]));
          }
        }
      }
    }
  }

  [[nodiscard]] bool has(Index node, double reach) const {
    const auto found = way_.find(node);
    return found != way_.end() && found->second <= reach;
  }

 private:
  std::map<Index, double> way_;
};

bool stands_before(const InitialPenetration& a, const InitialPenetration& b) noexcept {
  return std::tie(a.first, a.second) < std::tie(b.first, b.second);
}
bool stands_before(const Crossing& a, const Crossing& b) noexcept {
  return std::tie(a.element, a.edge) < std::tie(b.element, b.edge);
}

/// What may be near what, found as contact finds it.
class Finder {
 public:
  Finder(const model::Model& model, std::span<const Vec3d> position) : model_(model), x_(position) {
    thickest_.resize(model.bodies.size());
    for (Index n = 0; n < model.node_count(); ++n) {
      double& thickest = thickest_[at(model.node_body[at(n)])];
      thickest = std::max(thickest, model.half_thickness[at(n)]);
    }
    motion_.resize(position.size());
    for (std::size_t n = 0; n < position.size(); ++n) {
      motion_[n].position = position[n];
    }
    std::vector<Index> bodies(at(model.meshed_body_count()));
    std::iota(bodies.begin(), bodies.end(), 0);
    search_.assign(model, bodies);
    search_.find_partners(model, positions(), 0.0);
  }

  [[nodiscard]] std::vector<InitialPenetration> near_elements();
  [[nodiscard]] std::vector<InitialPenetration> near_edges();
  [[nodiscard]] std::vector<Crossing> crossing_edges() const;

 private:
  void near_elements(Index node, std::span<const Index> elements, std::vector<InitialPenetration>& found) const;
  void near_edges(Index edge, std::span<const Index> others, std::vector<InitialPenetration>& found) const;
  void crossing_edge(Index edge, Index element, std::vector<Crossing>& found) const;
  [[nodiscard]] Positions positions() const noexcept { return {motion_.data(), 0.0}; }
  [[nodiscard]] Box box_of(Index element) const {
    Box box;
    for (const Index n : model_.triangle[at(element)]) {
      box.include(x_[at(n)]);
    }
    return box;
  }
  [[nodiscard]] NearbyNodes nearby(std::span<const Index> nodes) const {
    return {model_, nodes, short_way_part * 2.0 * thickest_[at(model_.node_body[at(nodes.front())])]};
  }

  const model::Model& model_;
  std::span<const Vec3d> x_;
  std::vector<double> thickest_;           // [bodies]: half thickness
  std::vector<model::NodeMotion> motion_;  // At x_
  WholeSearch search_;
};

/// Calls work(i, results) for every i below `count` in parallel, and sorts all results.
template <class Result, class Work>
std::vector<Result> gathered(Index count, const Work& work) {
  std::vector<std::vector<Result>> pieces(at((count + items_per_piece - 1) / items_per_piece));
  parallel::for_each(static_cast<Index>(pieces.size()), 1, [&](Index piece) {
    for (Index i = piece * items_per_piece; i < std::min((piece + 1) * items_per_piece, count); ++i) {
      work(i, pieces[at(piece)]);
    }
  });
  std::vector<Result> all;
  for (const std::vector<Result>& piece : pieces) {
    all.insert(all.end(), piece.begin(), piece.end());
  }
  std::sort(all.begin(), all.end(), [](const Result& a, const Result& b) { return stands_before(a, b); });
  return all;
}

std::vector<InitialPenetration> Finder::near_elements() {
  CandidateRows c;
  search_.find_nodes(model_, positions(), 0.0, {}, c);
  return gathered<InitialPenetration>(static_cast<Index>(c.owner.size()), [&](Index row, auto& results) {
    const std::size_t r = at(row);
    near_elements(c.owner[r], std::span(c.partner).subspan(at(c.start[r]), at(c.start[r + 1] - c.start[r])), results);
  });
}

std::vector<InitialPenetration> Finder::near_edges() {
  CandidateRows c;
  search_.find_edges(positions(), 0.0, {}, c);
  return gathered<InitialPenetration>(static_cast<Index>(c.owner.size()), [&](Index row, auto& results) {
    const std::size_t r = at(row);
    near_edges(c.owner[r], std::span(c.partner).subspan(at(c.start[r]), at(c.start[r + 1] - c.start[r])), results);
  });
}

/// All edges of the blocks that are partners with all elements of these, boxes first.
std::vector<Crossing> Finder::crossing_edges() const {
  const BlockPairs& pairs = search_.partners();
  return gathered<Crossing>(pairs.count(), [&](Index block, auto& results) {
    const model::ElementBlock& own = model_.blocks[at(pairs.blocks()[at(block)])];
    std::array<Box, at(model::block_lanes)> boxes;
    Box whole;
    for (Index i = 0; i < own.count; ++i) {
      boxes[at(i)] = box_of(own.first + i);
      whole.include(boxes[at(i)]);
    }
    const IndexRange partners = pairs.partners_of(block);
    for (Index p = partners.begin; p < partners.end; ++p) {
      for (const NearEdge& edge : search_.edges_of(pairs.partners()[at(p)])) {
        Box box{x_[at(edge.node[0])], x_[at(edge.node[0])]};
        box.include(x_[at(edge.node[1])]);
        if (!whole.overlaps(box)) {
          continue;
        }
        for (Index i = 0; i < own.count; ++i) {
          if (boxes[at(i)].overlaps(box)) {
            crossing_edge(edge.number, own.first + i, results);
          }
        }
      }
    }
  });
}

void Finder::near_elements(Index node, std::span<const Index> elements, std::vector<InitialPenetration>& found) const {
  const Vec3d& point = x_[at(node)];
  const Index body = model_.node_body[at(node)];
  const std::size_t first = found.size();
  for (const Index e : elements) {
    const auto& t = model_.triangle[at(e)];
    const physics::ClosestPoint closest = physics::closest_point(point, x_[at(t[0])], x_[at(t[1])], x_[at(t[2])]);
    double distance = model_.half_thickness[at(node)];
    for (std::size_t a = 0; a < 3; ++a) {
      distance += closest.weight[a] * model_.half_thickness[at(t[a])];
    }
    const double limit = touching_part * distance;
    if (closest.distance2 < limit * limit) {
      found.push_back({node, e, false, std::sqrt(closest.distance2), distance});
    }
  }
  const auto of_body = [&](const InitialPenetration& p) { return body_of_element(model_, p.second) == body; };
  if (std::any_of(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(), of_body)) {
    const NearbyNodes near = nearby(std::span(&node, 1));
    std::erase_if(found, [&](const InitialPenetration& p) {
      return p.first == node && of_body(p) && std::ranges::any_of(model_.triangle[at(p.second)], [&](Index n) {
               return near.has(n, short_way_part * p.contact_distance);
             });
    });
  }
}

void Finder::near_edges(Index edge, std::span<const Index> others, std::vector<InitialPenetration>& found) const {
  const std::array<Index, 2> p = ends_of(model_, edge);
  const Index body = model_.node_body[at(p[0])];
  const std::size_t first = found.size();
  for (const Index other : others) {
    const std::array<Index, 2> q = ends_of(model_, other);
    const physics::ClosestOnLines c = physics::closest_on_lines(x_[at(p[0])], x_[at(p[1])], x_[at(q[0])], x_[at(q[1])]);
    constexpr double least = physics::feature_tolerance, most = 1.0 - physics::feature_tolerance;
    if (!(c.sine2 > physics::parallel_sine2) || !(c.first > least) || !(c.first < most) || !(c.second > least) ||
        !(c.second < most)) {
      continue;
    }
    const auto& half = model_.half_thickness;
    const double distance = (1.0 - c.first) * half[at(p[0])] + c.first * half[at(p[1])] +
                            (1.0 - c.second) * half[at(q[0])] + c.second * half[at(q[1])];
    if (std::abs(c.gap) < touching_part * distance) {
      found.push_back({edge, other, true, std::abs(c.gap), distance});
    }
  }
  const auto of_body = [&](const InitialPenetration& f) {
    return model_.node_body[at(ends_of(model_, f.second)[0])] == body;
  };
  if (std::any_of(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(), of_body)) {
    const NearbyNodes near = nearby(p);
    std::erase_if(found, [&](const InitialPenetration& f) {
      return f.first == edge && of_body(f) && std::ranges::any_of(ends_of(model_, f.second), [&](Index n) {
               return near.has(n, short_way_part * f.contact_distance);
             });
    });
  }
}

void Finder::crossing_edge(Index edge, Index element, std::vector<Crossing>& found) const {
  const auto& t = model_.triangle[at(element)];
  const std::array<Index, 2> n = ends_of(model_, edge);
  const auto is_corner = [&](Index node) { return node == t[0] || node == t[1] || node == t[2]; };
  if (is_corner(n[0]) || is_corner(n[1])) {
    return;
  }
  const Vec3d &a = x_[at(t[0])], &b = x_[at(t[1])], &c = x_[at(t[2])];
  const Vec3d area = cross(b - a, c - a);
  const Vec3d normal = (1.0 / norm(area)) * area;
  const Vec3d &from = x_[at(n[0])], &to = x_[at(n[1])];
  const double start = dot(from - a, normal), end = dot(to - a, normal);
  if (start * end >= 0.0 || std::min(std::abs(start), std::abs(end)) < in_plane_part * norm(to - from)) {
    return;
  }
  const Vec3d point = from + (start / (start - end)) * (to - from);
  const auto share = [&](const Vec3d& p, const Vec3d& q) { return dot(cross(p - point, q - point), area); };
  const double least = physics::feature_tolerance * dot(area, area);
  if (share(a, b) > least && share(b, c) > least && share(c, a) > least) {
    found.push_back({edge, element});
  }
}

Index body_of_first(const model::Model& model, const InitialPenetration& p) {
  return p.of_edges ? body_of_element(model, p.first / 3) : model.node_body[at(p.first)];
}
Index body_of_second(const model::Model& model, const InitialPenetration& p) {
  return body_of_element(model, p.of_edges ? p.second / 3 : p.second);
}

/// Whether a tie joins one of the nodes with a node of the body: there surfaces are meant to be near.
bool are_tied_to(const model::Model& model, std::span<const Index> nodes, Index body) {
  const auto& joined = model.ties.joined;
  return std::ranges::any_of(nodes, [&](Index node) {
    auto pair = std::lower_bound(joined.begin(), joined.end(), std::pair{node, Index{}});
    while (pair != joined.end() && pair->first == node && model.node_body[at(pair->second)] != body) {
      ++pair;
    }
    return pair != joined.end() && pair->first == node;
  });
}

bool is_at_tie(const model::Model& model, const InitialPenetration& p) {
  const Index body = body_of_first(model, p), other = body_of_second(model, p);
  if (p.of_edges) {
    return are_tied_to(model, ends_of(model, p.first), other) || are_tied_to(model, ends_of(model, p.second), body);
  }
  return are_tied_to(model, std::span(&p.first, 1), other) || are_tied_to(model, model.triangle[at(p.second)], body);
}

bool is_at_tie(const model::Model& model, const Crossing& crossing) {
  const Index body = body_of_element(model, crossing.edge / 3), other = body_of_element(model, crossing.element);
  return are_tied_to(model, ends_of(model, crossing.edge), other) ||
         are_tied_to(model, model.triangle[at(crossing.element)], body);
}

}  // namespace

InitialPenetrations find_initial_penetrations(const model::Model& model, std::span<const Vec3d> position) {
  InitialPenetrations found;
  if (!model.contact.enabled) {
    return found;
  }
  Finder finder(model, position);
  found.pairs = finder.near_elements();
  if (model.contact.edges) {
    const std::vector<InitialPenetration> edges = finder.near_edges();
    found.pairs.insert(found.pairs.end(), edges.begin(), edges.end());
  }
  found.crossings = finder.crossing_edges();
  if (!model.ties.empty()) {
    std::erase_if(found.pairs, [&](const InitialPenetration& p) { return is_at_tie(model, p); });
    std::erase_if(found.crossings, [&](const Crossing& crossing) { return is_at_tie(model, crossing); });
  }
  return found;
}

std::vector<PenetratingBodies> by_bodies(const model::Model& model, const InitialPenetrations& found) {
  std::map<std::tuple<Index, Index, bool>, PenetratingBodies> groups;
  const auto group_of = [&](Index body, Index other) -> PenetratingBodies& {
    const auto [low, high] = std::minmax(model.bodies[at(body)].description, model.bodies[at(other)].description);
    PenetratingBodies& group = groups[{low, high, body == other}];
    if (group.count == 0 && group.crossings == 0) {
      group.body = body;
      group.other = other;
      group.same_body = body == other;
    }
    return group;
  };
  std::map<const PenetratingBodies*, Index> last_node;
  for (const InitialPenetration& p : found.pairs) {
    const Index body = body_of_first(model, p), other = body_of_second(model, p);
    PenetratingBodies& group = group_of(body, other);
    if (group.count == 0 || p.depth() > group.deepest.depth()) {
      group.deepest = p;
      group.body = body;
      group.other = other;
    }
    if (p.of_edges) {
      ++group.count;
    } else if (const auto [last, is_new] = last_node.try_emplace(&group, p.first); is_new || last->second != p.first) {
      last->second = p.first;
      ++group.count;
    }
  }
  for (const Crossing& crossing : found.crossings) {
    PenetratingBodies& group =
        group_of(body_of_element(model, crossing.edge / 3), body_of_element(model, crossing.element));
    if (group.crossings == 0) {
      group.first_crossing = crossing;
    }
    ++group.crossings;
  }
  std::vector<PenetratingBodies> all;
  for (const auto& [key, group] : groups) {
    all.push_back(group);
  }
  return all;
}

}  // namespace fexp::contact
