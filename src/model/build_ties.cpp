// SPDX-License-Identifier: Apache-2.0
#include "model/build_ties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "model/build_checks.hpp"
#include "model/build_rigid.hpp"
#include "model/condition_lookup.hpp"
#include "model/node_sets.hpp"
#include "model/surface_search.hpp"

namespace fexp::model {

namespace {

/// Room that is left for nodes which the mesh puts a little off the distance of touching surfaces.
constexpr double tie_room = 1.05;
/// Weights below this count as zero: such a corner carries nothing.
constexpr double least_weight = 1.0e-12;
/// Arms shorter than this part of the node's elements, or of its place, are none: they would be lost in rounding.
constexpr double shortest_arm = 1.0e-9, position_rounding = 1.0e-12;
constexpr std::uint8_t every_dof = 0x3F, every_translation = 0x07;

class TieBuilder {
 public:
  TieBuilder(const Description& description, Model& model, ErrorList& errors)
      : description_(description),
        model_(model),
        errors_(errors),
        lookup_(model),
        tie_of_(model.mass.size(), no_index) {}

  void add(Index number) {
    const TieDescription& given = description_.ties[at(number)];
    TieResult& result = model_.ties.results.emplace_back();
    result.name = given.name;
    const std::size_t errors_before = errors_.size();
    model_.ties.can_break = model_.ties.can_break || has_strength(given);
    const std::vector<Index> bodies =
        BodyNames(model_).find(given.surface, given.place, fmt::format("tie \"{}\"", given.name), errors_);
    if (given.surface.empty()) {
      errors_.add(given.place, fmt::format("tie \"{}\" names no body as its surface", given.name),
                  name_list(BodyNames(model_).families()), "name the bodies that carry the nodes");
    }
    if (bodies.empty() || errors_.size() != errors_before || !may_break(given, bodies) || !may_be_tied(given, bodies)) {
      return;
    }
    const SurfaceSearch surface(model_, bodies);
    result.distance = HUGE_VAL;
    for (const Index n : lookup_.nodes(given.set)) {
      if (!tie(given, number, surface, n, result)) {
        return;
      }
    }
    if (result.tied == 0) {
      errors_.add(given.place,
                  fmt::format("tie \"{}\": no node of set \"{}\" is near its surface, the closest is {:.6g} away",
                              given.name, given.set, result.distance),
                  given.distance > 0.0 ? fmt::format("nodes within distance = {:g}", given.distance)
                                       : "nodes within half the thicknesses of both sides and 5 %",
                  "give a larger distance, or correct the set, the surface or where the bodies are");
    }
  }

  /// Puts nodes that hang on held ones among these.
  void hold() {
    model_.fixed.insert(model_.fixed.end(), held_.begin(), held_.end());
    std::stable_sort(model_.fixed.begin(), model_.fixed.end(),
                     [](const FixedNode& a, const FixedNode& b) { return a.node < b.node; });
  }

  /// No carrier is tied itself: forces are handed on once.
  void check_chains() {
    for (const Tie& tie : model_.ties.ties) {
      for (std::size_t a = 0; a < 3; ++a) {
        const Index other = tie.weight[a] > 0.0 ? tie_of_[at(tie.carrier[a])] : no_index;
        if (other != no_index) {
          const TieDescription& given = description_.ties[at(tie.description)];
          errors_.add(
              given.place,
              fmt::format("tie \"{}\": {} is tied to a triangle at {}, which tie \"{}\" has tied itself", given.name,
                          text_of(tie.node), text_of(tie.carrier[a]), description_.ties[at(other)].name),
              "surfaces whose nodes are not tied", "tie both to a third body, or take nodes out of the sets");
          return;
        }
      }
    }
  }

 private:
  [[nodiscard]] std::string text_of(Index node) const {
    return fmt::format("node {} of body \"{}\"", model_.node_label[at(node)],
                       model_.bodies[at(model_.node_body[at(node)])].name);
  }

  template <class Item>
  [[nodiscard]] static auto first_at(const std::vector<Item>& items, Index node) {
    return std::lower_bound(items.begin(), items.end(), node, [](const Item& item, Index n) { return item.node < n; });
  }

  template <class Item>
  [[nodiscard]] static bool has(const std::vector<Item>& items, Index node) {
    const auto found = first_at(items, node);
    return found != items.end() && found->node == node;
  }

  [[nodiscard]] static bool has_strength(const TieDescription& given) {
    return given.strength_normal > 0.0 || given.strength_shear > 0.0;
  }

  /// A rigid body keeps its mass: nodes that it carries cannot leave it.
  bool may_break(const TieDescription& given, const std::vector<Index>& surface) {
    const auto moves = [&](Index body) {
      return model_.bodies[at(body)].rigid != no_index && !is_held(model_.bodies[at(body)]);
    };
    const auto found = has_strength(given) ? std::ranges::find_if(surface, moves) : surface.end();
    if (found != surface.end()) {
      errors_.add(given.place,
                  fmt::format("tie \"{}\" has a strength, and body \"{}\" of its surface is rigid and moves",
                              given.name, model_.bodies[at(*found)].name),
                  "surfaces that deform, or rigid ones that are held in all degrees of freedom",
                  "take the strength away, let the body deform, or hold it");
    }
    return found == surface.end();
  }

  [[nodiscard]] bool is_held(const Body& body) const {
    const auto found = first_at(model_.fixed, body.nodes.begin);
    return found != model_.fixed.end() && found->node == body.nodes.begin && found->mask == every_dof;
  }

  bool may_be_tied(const TieDescription& given, const std::vector<Index>& surface) {
    return std::ranges::all_of(lookup_.nodes(given.set), [&](Index n) { return may_be_tied(given, surface, n); });
  }

  [[nodiscard]] bool has_condition(Index n) const {
    return has(model_.fixed, n) || has(model_.prescribed, n) || has(model_.symmetry, n) || has(model_.oblique, n);
  }

  bool may_be_tied(const TieDescription& given, const std::vector<Index>& surface, Index n) {
    const Index index = model_.node_body[at(n)];
    const Body& body = model_.bodies[at(index)];
    if (std::binary_search(surface.begin(), surface.end(), index)) {
      errors_.add(given.place,
                  fmt::format("tie \"{}\": set \"{}\" has nodes of body \"{}\", which is its surface", given.name,
                              given.set, body.name),
                  "nodes of other bodies", "choose other nodes, or make the two parts of the body two bodies");
      return false;
    }
    if (body.rigid != no_index) {
      errors_.add(given.place,
                  fmt::format("tie \"{}\": set \"{}\" has nodes of body \"{}\", which is rigid", given.name, given.set,
                              body.name),
                  "nodes of bodies that deform", "swap the sides: tie nodes of the other body to the rigid one");
      return false;
    }
    if (has_condition(n)) {
      errors_.add(
          given.place,
          fmt::format("tie \"{}\": {} has a condition besides (fixed, prescribed or symmetry)", given.name, text_of(n)),
          "nodes that only the tie holds", "take the node out of one of the sets, or swap the sides of the tie");
      return false;
    }
    return true;
  }

  /// False after an error.
  bool tie(const TieDescription& given, Index number, const SurfaceSearch& surface, Index n, TieResult& result) {
    const Vec3d& x = model_.reference_position[at(n)];
    const SurfaceSearch::Found found = surface.closest(x);
    if (found.element == no_index) {
      return true;
    }
    const auto& corner = model_.triangle[at(found.element)];
    double limit = given.distance, distance = std::sqrt(found.closest.distance2);
    if (limit < 0.0) {
      limit = model_.half_thickness[at(n)];
      for (std::size_t a = 0; a < 3; ++a) {
        limit += found.closest.weight[a] * model_.half_thickness[at(corner[a])];
      }
      limit *= tie_room;
    }
    if (distance > limit) {
      result.far.push_back(n);
      result.distance = std::min(result.distance, distance);
      return true;
    }
    if (tie_of_[at(n)] != no_index) {
      errors_.add(given.place,
                  fmt::format("tie \"{}\": {} is tied already by tie \"{}\"", given.name, text_of(n),
                              description_.ties[at(tie_of_[at(n)])].name),
                  "one tie for a node", "take the node out of one of the sets");
      return false;
    }
    tie_of_[at(n)] = number;
    ++result.tied;
    const Tie& made = model_.ties.ties.emplace_back(made_of(given, number, n, corner, found.closest));
    if (made.is_fixed()) {
      held_.push_back({n, given.rotations ? every_dof : every_translation});
    }
    return true;
  }

  /// Whether the carriers hold the node, as they do not move nor turn.
  [[nodiscard]] bool are_held(const std::array<Index, 3>& corner, const std::array<double, 3>& weight) const {
    bool held = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto found = first_at(model_.fixed, corner[a]);
      const bool all = found != model_.fixed.end() && found->node == corner[a] && found->mask == every_dof;
      held = held && (all || !(weight[a] > least_weight));
    }
    return held;
  }

  [[nodiscard]] Tie made_of(const TieDescription& given, Index number, Index n, const std::array<Index, 3>& corner,
                            const physics::ClosestPoint& closest) const {
    Tie tie;
    tie.node = n;
    tie.carrier = corner;
    tie.rotations = given.rotations;
    tie.description = number;
    tie.held = are_held(corner, closest.weight);
    tie.breaks = has_strength(given);
    tie.rigid = tie.held ? no_index : model_.bodies[at(model_.node_body[at(corner[0])])].rigid;
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      tie.weight[a] = closest.weight[a] > least_weight ? closest.weight[a] : 0.0;
      tie.conditions = tie.conditions || (tie.weight[a] > 0.0 && has_condition(corner[a]));
      sum += tie.weight[a];
    }
    Vec3d arm = model_.reference_position[at(n)];
    for (std::size_t a = 0; a < 3; ++a) {
      tie.weight[a] /= sum;
      arm -= tie.weight[a] * model_.reference_position[at(corner[a])];
    }
    const double shortest =
        std::max(shortest_arm * model_.node_size[at(n)], position_rounding * norm(model_.reference_position[at(n)]));
    tie.length = norm(arm) > shortest ? norm(arm) : 0.0;
    return tie;
  }

  const Description& description_;
  Model& model_;
  ErrorList& errors_;
  Lookup lookup_;
  std::vector<FixedNode> held_;
  std::vector<Index> tie_of_;  // [nodes]: into Description::ties
};

/// Pairs of bodies, and nodes that are joined.
void join(Model& model) {
  Ties& ties = model.ties;
  for (const Tie& tie : ties.ties) {
    if (tie.is_fixed()) {
      continue;
    }
    const Index body = model.node_body[at(tie.node)], carrier = model.node_body[at(tie.carrier[0])];
    if (!tie.held) {
      ties.bodies.push_back({body, carrier, tie.length});
    }
    for (std::size_t a = 0; a < 3; ++a) {
      ties.joined.emplace_back(tie.node, tie.carrier[a]);
      ties.joined.emplace_back(tie.carrier[a], tie.node);
    }
  }
  std::sort(ties.joined.begin(), ties.joined.end());
  ties.joined.erase(std::unique(ties.joined.begin(), ties.joined.end()), ties.joined.end());
  std::sort(ties.bodies.begin(), ties.bodies.end(), [](const TiedBodies& a, const TiedBodies& b) {
    return a.body != b.body ? a.body < b.body : a.carrier != b.carrier ? a.carrier < b.carrier : a.arm > b.arm;
  });
  const auto same = [](const TiedBodies& a, const TiedBodies& b) { return a.body == b.body && a.carrier == b.carrier; };
  ties.bodies.erase(std::unique(ties.bodies.begin(), ties.bodies.end(), same), ties.bodies.end());
}

}  // namespace

bool Ties::are_joined(Index a, Index b) const noexcept {
  return std::binary_search(joined.begin(), joined.end(), std::pair{a, b});
}

Index Ties::tie_of(Index node) const noexcept {
  const auto found = std::ranges::lower_bound(ties, node, {}, &Tie::node);
  return found != ties.end() && found->node == node ? static_cast<Index>(found - ties.begin()) : no_index;
}

void build_ties(const Description& description, Model& model, ErrorList& errors) {
  if (description.ties.empty() || !errors.empty()) {
    return;
  }
  TieBuilder builder(description, model, errors);
  for (std::size_t i = 0; i < description.ties.size(); ++i) {
    builder.add(static_cast<Index>(i));
  }
  std::sort(model.ties.ties.begin(), model.ties.ties.end(), [](const Tie& a, const Tie& b) { return a.node < b.node; });
  builder.hold();
  builder.check_chains();
  if (!errors.empty()) {
    return;
  }
  join(model);
  give_strengths(description, model);
  weigh_ties(model);
  add_tied_masses(model);
}

}  // namespace fexp::model
