// SPDX-License-Identifier: Apache-2.0
#include "contact/separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "contact/surface.hpp"
#include "physics/closest_lines.hpp"
#include "physics/closest_point.hpp"

namespace fexp::contact {

namespace {

/// Passes over all pairs; each pair is put right for itself, which moves others [MHHR07].
constexpr int most_sweeps = 50;
/// Times that nodes which had to be put back are held, and the others are moved again.
constexpr int most_rounds = 10;
/// By how much more than contact distance shells are moved apart, so that rounding leaves nothing.
constexpr double clearance = 1.0e-9;
/// An element may lose this part of its area and of its least height, and turn by 60 degrees.
constexpr double least_part = 0.5;
constexpr double least_cosine = 0.5;

/// Least height of a triangle, and twice its area along the normal.
struct Shape {
  Shape(const std::vector<Vec3d>& x, const std::array<Index, 3>& t) {
    const Vec3d a = x[at(t[1])] - x[at(t[0])], b = x[at(t[2])] - x[at(t[1])], c = x[at(t[0])] - x[at(t[2])];
    area = cross(a, b);
    height = norm(area) / std::sqrt(std::max({dot(a, a), dot(b, b), dot(c, c)}));
  }
  Vec3d area;       ///< [length^2]
  double height{};  ///< [length]
};

class Mover {
 public:
  explicit Mover(const model::Model& model) : model_(model), x_(model.reference_position) {
    held_.assign(x_.size(), 0);
    for (const model::Body& body : model.bodies) {
      if (body.barrier || body.rigid != no_index) {
        std::fill(held_.begin() + body.nodes.begin, held_.begin() + body.nodes.end, 1);
      }
    }
    hold(model.fixed);
    hold(model.prescribed);
    hold(model.symmetry);
    hold(model.oblique);
  }

  [[nodiscard]] const std::vector<Vec3d>& position() const noexcept { return x_; }

  /// Moves the nodes of a pair so far apart as they have to be. False where neither side can be moved.
  bool part(const InitialPenetration& pair) { return pair.of_edges ? part_edges(pair) : part_node(pair); }

  /// Puts nodes of elements that are spoilt, and of crossings, back where they were, and holds them. True when there
  /// were any.
  bool put_back() {
    const std::vector<Vec3d>& before = model_.reference_position;
    bool any = false;
    for (const std::array<Index, 3>& t : model_.triangle) {
      const Shape was(before, t), is(x_, t);
      const double area = norm(was.area) * norm(is.area);
      const bool good = dot(was.area, is.area) > least_cosine * area && norm(is.area) > least_part * norm(was.area) &&
                        is.height > least_part * was.height;
      any = (!good && put_back(t)) || any;
    }
    for (const Crossing& crossing : find_initial_penetrations(model_, x_).crossings) {
      any = put_back(model_.triangle[at(crossing.element)]) || any;
      any = put_back(ends_of(model_, crossing.edge)) || any;
    }
    return any;
  }

 private:
  template <class Condition>
  void hold(const std::vector<Condition>& conditions) {
    for (const Condition& condition : conditions) {
      held_[at(condition.node)] = 1;
    }
  }

  template <class Nodes>
  bool put_back(const Nodes& nodes) {
    bool any = false;
    for (const Index n : nodes) {
      any = any || x_[at(n)] != model_.reference_position[at(n)];
      x_[at(n)] = model_.reference_position[at(n)];
      held_[at(n)] = 1;
    }
    return any;
  }

  [[nodiscard]] double freedom(Index node) const { return held_[at(node)] != 0 ? 0.0 : 1.0; }

  bool part_node(const InitialPenetration& pair) {
    const auto& t = model_.triangle[at(pair.second)];
    const Vec3d &a = x_[at(t[0])], &b = x_[at(t[1])], &c = x_[at(t[2])];
    const physics::ClosestPoint closest = physics::closest_point(x_[at(pair.first)], a, b, c);
    double distance = model_.half_thickness[at(pair.first)], freedoms = freedom(pair.first);
    for (std::size_t i = 0; i < 3; ++i) {
      distance += closest.weight[i] * model_.half_thickness[at(t[i])];
      freedoms += closest.weight[i] * closest.weight[i] * freedom(t[i]);
    }
    const double present = std::sqrt(closest.distance2);
    if (!(present < distance)) {
      return true;
    }
    if (!(freedoms > 0.0)) {
      return false;
    }
    const Vec3d area = cross(b - a, c - a);
    const Vec3d way = present > 0.0 ? (1.0 / present) * closest.offset : (1.0 / norm(area)) * area;
    const Vec3d move = (((1.0 + clearance) * distance - present) / freedoms) * way;
    x_[at(pair.first)] += freedom(pair.first) * move;
    for (std::size_t i = 0; i < 3; ++i) {
      x_[at(t[i])] -= closest.weight[i] * freedom(t[i]) * move;
    }
    return true;
  }

  bool part_edges(const InitialPenetration& pair) {
    const std::array<Index, 2> p = ends_of(model_, pair.first), q = ends_of(model_, pair.second);
    const physics::ClosestOnLines c = physics::closest_on_lines(x_[at(p[0])], x_[at(p[1])], x_[at(q[0])], x_[at(q[1])]);
    if (!(c.sine2 > 0.0) || c.first < 0.0 || c.first > 1.0 || c.second < 0.0 || c.second > 1.0) {
      return true;
    }
    const std::array<std::pair<Index, double>, 4> share{
        {{p[0], c.first - 1.0}, {p[1], -c.first}, {q[0], 1.0 - c.second}, {q[1], c.second}}};
    double distance = 0.0, freedoms = 0.0;
    for (const auto& [node, part] : share) {
      distance += std::abs(part) * model_.half_thickness[at(node)];
      freedoms += part * part * freedom(node);
    }
    const double present = std::abs(c.gap);
    if (!(present < distance)) {
      return true;
    }
    if (!(freedoms > 0.0)) {
      return false;
    }
    const Vec3d way = ((c.gap < 0.0 ? -1.0 : 1.0) / norm(c.normal)) * c.normal;
    for (const auto& [node, part] : share) {
      x_[at(node)] += (part * freedom(node) * ((1.0 + clearance) * distance - present) / freedoms) * way;
    }
    return true;
  }

  const model::Model& model_;
  std::vector<Vec3d> x_;
  std::vector<char> held_;  // [nodes]
};

}  // namespace

Separation separate(const model::Model& model, InitialPenetrations found) {
  Mover mover(model);
  Separation result;
  for (int round = 0; round < most_rounds; ++round) {
    for (int sweep = 0; sweep < most_sweeps && !found.pairs.empty(); ++sweep) {
      bool any = false;
      for (const InitialPenetration& pair : found.pairs) {
        any = mover.part(pair) || any;
      }
      found = find_initial_penetrations(model, mover.position());
      if (!any) {
        break;
      }
    }
    if (!mover.put_back()) {
      break;
    }
    found = find_initial_penetrations(model, mover.position());
  }
  // Nothing is left spoilt, whatever the last round has done.
  while (mover.put_back()) {
  }
  result.left = find_initial_penetrations(model, mover.position());
  result.position = mover.position();
  for (Index n = 0; n < model.node_count(); ++n) {
    const double way = norm(result.position[at(n)] - model.reference_position[at(n)]);
    result.moved += way > 0.0 ? 1 : 0;
    if (way > result.largest_move) {
      result.largest_move = way;
      result.farthest_node = n;
    }
  }
  return result;
}

}  // namespace fexp::contact
