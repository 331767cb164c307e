// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "quality/assess.hpp"
#include "quality/first_copies.hpp"

namespace fexp::quality {

namespace {

/// Pieces of all bodies: nodes that elements connect, each piece named by its lowest node.
class Pieces {
 public:
  explicit Pieces(const model::Model& model) : parent_(at(model.node_count())) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const auto& t : model.triangle) {
      join(t[0], t[1]);
      join(t[0], t[2]);
    }
    for (Index n = 0; n < model.node_count(); ++n) {
      parent_[at(n)] = parent_[at(parent_[at(n)])];  // A parent is lower than its children, so it is done already.
    }
  }
  [[nodiscard]] Index of(Index node) const { return parent_[at(node)]; }

 private:
  Index root(Index n) {
    while (parent_[at(n)] != n) {
      parent_[at(n)] = parent_[at(parent_[at(n)])];
      n = parent_[at(n)];
    }
    return n;
  }
  void join(Index a, Index b) {
    const Index x = root(a), y = root(b);
    parent_[at(std::max(x, y))] = std::min(x, y);
  }

  std::vector<Index> parent_;
};

/// First element of every piece, by the piece's lowest node; no_index elsewhere.
std::vector<Index> first_elements(const model::Model& model, const Pieces& pieces) {
  std::vector<Index> first(at(model.node_count()), no_index);
  for (Index e = model.element_count() - 1; e >= 0; --e) {
    first[at(pieces.of(model.triangle[at(e)][0]))] = e;
  }
  return first;
}

/// Whether something holds, loads or moves a piece, by its lowest node.
std::vector<char> acted_upon(const model::Model& model, const Pieces& pieces) {
  std::vector<char> acted(at(model.node_count()), 0);
  const auto mark = [&](Index node) { acted[at(pieces.of(node))] = 1; };
  const auto mark_nodes_of = [&](const auto& conditions) {
    for (const auto& condition : conditions) {
      mark(condition.node);
    }
  };
  mark_nodes_of(model.fixed);
  mark_nodes_of(model.prescribed);
  mark_nodes_of(model.symmetry);
  mark_nodes_of(model.oblique);
  mark_nodes_of(model.forces);
  for (const model::Tie& tie : model.ties.ties) {
    mark(tie.node);
    mark(tie.carrier[0]);
  }
  for (const model::PressureLoad& pressure : model.pressure) {
    mark(model.triangle[at(pressure.element)][0]);
  }
  const bool falls = std::any_of(model.gravity.begin(), model.gravity.end(),
                                 [](const model::GravityLoad& g) { return norm(g.acceleration) > 0.0; });
  for (Index n = 0; n < model.node_count(); ++n) {
    if (falls || norm(model.initial_velocity[at(n)]) > 0.0 || norm(model.initial_rotation_rate[at(n)]) > 0.0) {
      mark(n);
    }
  }
  return acted;
}

/// Whether contact may bring other bodies, or other pieces of the same, against a body, or a rigid wall may come to it.
std::vector<char> can_be_hit(const model::Model& model, const std::vector<Index>& pieces_of_body) {
  std::vector<Index> excluded(model.bodies.size(), 0);
  std::vector<char> hit(model.bodies.size(), 0);
  const bool walls_move = std::any_of(model.walls.begin(), model.walls.end(),
                                      [](const model::Wall& wall) { return wall.moves || wall.body != no_index; });
  for (const auto& [a, b] : model.excluded_pairs) {
    excluded[at(a)] += a != b ? 1 : 0;
    excluded[at(b)] += a != b ? 1 : 0;
  }
  for (Index b = 0; b < model.body_count(); ++b) {
    const bool others = model.contact.enabled && excluded[at(b)] < model.meshed_body_count() - 1;
    hit[at(b)] = static_cast<char>(others || walls_move || (pieces_of_body[at(b)] > 1 && model.can_touch(b, b)));
  }
  return hit;
}

Finding pieces_finding(const model::Model& model, const model::Body& body, const Pieces& pieces,
                       const std::vector<Index>& first_element) {
  Finding finding;
  finding.kind = "pieces";
  finding.body = body.family;
  finding.item = "element";
  std::vector<Index> size(at(body.nodes.size()), 0);
  for (Index e = body.elements.begin; e < body.elements.end; ++e) {
    ++size[at(pieces.of(model.triangle[at(e)][0]) - body.nodes.begin)];
  }
  std::string sizes;
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    if (first_element[at(n)] != no_index) {
      sizes += finding.ids.size() < most_ids
                   ? fmt::format("{}{}", sizes.empty() ? "" : ", ", size[at(n - body.nodes.begin)])
                   : "";
      add_item(finding, model.element_label[at(first_element[at(n)])]);
    }
  }
  finding.message = fmt::format("its mesh is in {} pieces that no node connects, of {}{} elements", finding.count,
                                sizes, finding.count > static_cast<std::int64_t>(most_ids) ? ", ..." : "");
  finding.cure =
      "they move independently of each other; weld the nodes between them (weld_tolerance for STL), or make them "
      "bodies of their own";
  return finding;
}

std::string these(std::int64_t pieces) { return pieces == 1 ? "it" : fmt::format("{} pieces of it", pieces); }

}  // namespace

std::vector<Finding> loose_pieces(const model::Model& model) {
  std::vector<Finding> findings;
  const Pieces pieces(model);
  const std::vector<Index> first_element = first_elements(model, pieces);
  std::vector<Index> pieces_of_body(model.bodies.size(), 0);
  for (Index n = 0; n < model.node_count(); ++n) {
    pieces_of_body[at(model.node_body[at(n)])] += first_element[at(n)] != no_index ? 1 : 0;
  }
  for (const Index b : first_copies(model)) {
    if (pieces_of_body[at(b)] > 1) {
      findings.push_back(pieces_finding(model, model.bodies[at(b)], pieces, first_element));
    }
  }
  const std::vector<char> acted = acted_upon(model, pieces), hit = can_be_hit(model, pieces_of_body);
  Index previous = no_index;  // Description of the finding that is being filled
  for (Index n = 0; n < model.node_count(); ++n) {
    if (first_element[at(n)] == no_index || acted[at(n)] != 0) {
      continue;
    }
    const Index b = model.node_body[at(n)];
    const model::Body& body = model.bodies[at(b)];
    if (body.description != previous) {
      Finding& finding = findings.emplace_back();
      finding.body = body.family;
      finding.item = "element";
      finding.kind = hit[at(b)] != 0 ? "waiting" : "idle";
      finding.severity = hit[at(b)] != 0 ? Severity::note : Severity::warning;
      previous = body.description;
    }
    add_item(findings.back(), model.element_label[at(first_element[at(n)])]);
  }
  for (Finding& finding : findings) {
    if (finding.kind == "idle") {
      finding.message = "nothing holds, loads, moves or can hit " + these(finding.count);
      finding.cure = "it will stay as it is; give it a load, a condition or a velocity, or leave it out";
    } else if (finding.kind == "waiting") {
      finding.message = "nothing but contact can act on " + these(finding.count);
    }
  }
  return findings;
}

}  // namespace fexp::quality
