// SPDX-License-Identifier: Apache-2.0
#include "app/penetrations.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "contact/separation.hpp"
#include "contact/surface.hpp"
#include "model/build.hpp"
#include "solve/wall_penetrations.hpp"

namespace fexp::app {

namespace {

using Penetration = io::Summary::Penetration;

Penetration named(const model::Model& model, const contact::PenetratingBodies& bodies) {
  Penetration p;
  p.body = model.bodies[at(bodies.body)].name;
  p.other_body = model.bodies[at(bodies.other)].name;
  p.count = bodies.count;
  p.crossings = bodies.crossings;
  const auto add_node = [&](Index n) { p.nodes.push_back(model.node_label[at(n)]); };
  const auto add_element = [&](Index e) { p.elements.push_back(model.element_label[at(e)]); };
  if (bodies.count > 0) {
    const contact::InitialPenetration& deepest = bodies.deepest;
    p.depth = deepest.depth();
    p.contact_distance = deepest.contact_distance;
    if (deepest.of_edges) {
      for (const Index edge : {deepest.first, deepest.second}) {
        const std::array<Index, 2> ends = contact::ends_of(model, edge);
        add_node(ends[0]);
        add_node(ends[1]);
        add_element(edge / 3);
      }
    } else {
      add_node(deepest.first);
      add_element(deepest.second);
    }
  }
  if (bodies.crossings > 0) {
    p.crossing_body = model.bodies[at(contact::body_of_element(model, bodies.first_crossing.edge / 3))].name;
    for (const Index n : contact::ends_of(model, bodies.first_crossing.edge)) {
      p.crossing.push_back(model.node_label[at(n)]);
    }
    p.crossing.push_back(model.element_label[at(bodies.first_crossing.element)]);
  }
  return p;
}

std::vector<Penetration> named(const model::Model& model, const contact::InitialPenetrations& found) {
  std::vector<Penetration> list;
  for (const contact::PenetratingBodies& bodies : contact::by_bodies(model, found)) {
    list.push_back(named(model, bodies));
  }
  return list;
}

Penetration named(const model::Model& model, const solve::WallPenetration& inside) {
  Penetration p;
  p.body = model.bodies[at(inside.body)].name;
  p.wall = model.walls[at(inside.wall)].name;
  p.count = inside.count;
  p.depth = inside.depth;
  p.contact_distance = inside.contact_distance;
  p.nodes = {model.node_label[at(inside.node)]};
  return p;
}

/// Bodies are not moved out of walls, so that these are left as they are found.
void add_walls(const model::Model& model, std::vector<Penetration>& list) {
  for (const solve::WallPenetration& inside : solve::find_wall_penetrations(model)) {
    list.push_back(named(model, inside));
  }
}

std::string other_text(const Penetration& p) {
  return p.other_body == p.body ? "itself" : fmt::format("body \"{}\"", p.other_body);
}

/// Without the body's name.
std::string nearness_text(const Penetration& p) {
  if (!p.wall.empty()) {
    return fmt::format("inside rigid wall \"{}\" with {} nodes, at most by {:.4g} of {:.4g} half thickness: node {}",
                       p.wall, p.count, p.depth, p.contact_distance, p.nodes[0]);
  }
  const std::string where = p.nodes.size() == 1 ? fmt::format("node {} and element {}", p.nodes[0], p.elements[0])
                                                : fmt::format("the edges from node {} to {} and from node {} to {}",
                                                              p.nodes[0], p.nodes[1], p.nodes[2], p.nodes[3]);
  return fmt::format(
      "nearer to {} than the thicknesses allow at {} nodes or pairs of edges, at most by {:.4g} of {:.4g}: {}",
      other_text(p), p.count, p.depth, p.contact_distance, where);
}

std::string crossing_text(const Penetration& p) {
  return fmt::format("passes through {} at {} edges, the first from node {} to {} of body \"{}\", through element {}",
                     other_text(p), p.crossings, p.crossing[0], p.crossing[1], p.crossing_body, p.crossing[2]);
}

std::string nearness_cure(const Penetration& p, bool removed) {
  if (!p.wall.empty()) {
    return "the wall pushes them out from the first step on; move the body or the wall";
  }
  return removed ? "they keep their distance without a force; move the bodies, or mend the mesh"
                 : "they keep their distance without a force; move them apart, or let "
                   "contact.initial_penetrations = \"remove\" do it";
}

constexpr std::string_view crossing_cure =
    "move the bodies apart or mend the mesh, or leave the pair out with contact.exclude";

void add_lines(const std::vector<Penetration>& list, std::string_view begin, std::vector<std::string>& lines) {
  for (const Penetration& p : list) {
    if (p.count > 0) {
      lines.push_back(fmt::format("{}body \"{}\" is {}", begin, p.body, nearness_text(p)));
    }
    if (p.crossings > 0) {
      lines.push_back(fmt::format("{}body \"{}\" {}", begin, p.body, crossing_text(p)));
    }
  }
}

}  // namespace

void treat_penetrations(const std::vector<model::Mesh>& meshes, Case& loaded, ErrorList& errors) {
  const model::ContactSettings& settings = loaded.model.contact;
  io::Summary::InitialPenetrations& report = loaded.penetrations;
  contact::InitialPenetrations found =
      contact::find_initial_penetrations(loaded.model, loaded.model.reference_position);
  report.found = named(loaded.model, found);
  add_walls(loaded.model, report.found);
  if (settings.initial_penetrations != "remove" || (found.pairs.empty() && found.crossings.empty())) {
    return;
  }
  for (const Penetration& p : report.found) {
    if (p.crossings > 0) {
      errors.add(settings.place,
                 fmt::format("body \"{}\" {}, which contact.initial_penetrations = \"remove\" cannot undo", p.body,
                             crossing_text(p)),
                 "surfaces that do not pass through each other", fmt::format("{}, or write \"keep\"", crossing_cure));
    }
  }
  if (!errors.empty()) {
    return;
  }
  const contact::Separation apart = contact::separate(loaded.model, std::move(found));
  report.removed = true;
  report.moved_nodes = apart.moved;
  report.largest_move = apart.largest_move;
  report.farthest_node = apart.farthest_node == no_index ? -1 : loaded.model.node_label[at(apart.farthest_node)];
  report.left = named(loaded.model, apart.left);
  loaded.model = model::build_model(loaded.deck.description, meshes, errors, apart.position);
  add_walls(loaded.model, report.left);
}

std::vector<std::string> penetration_lines(const io::Summary::InitialPenetrations& p) {
  std::vector<std::string> lines;
  add_lines(p.found, "at the start ", lines);
  if (p.removed) {
    lines.push_back(fmt::format("{} nodes were moved apart before the start, the farthest, node {}, by {:.4g}",
                                p.moved_nodes, p.farthest_node, p.largest_move));
    add_lines(p.left, "warning: not removed: ", lines);
  }
  return lines;
}

std::vector<quality::Finding> penetration_findings(const io::Summary::InitialPenetrations& penetrations) {
  std::vector<quality::Finding> findings;
  const std::vector<Penetration>& list = penetrations.removed ? penetrations.left : penetrations.found;
  if (penetrations.removed) {
    quality::Finding& moved = findings.emplace_back();
    moved.kind = "moved_apart";
    moved.severity = quality::Severity::note;
    moved.message = fmt::format("{} nodes are moved apart before the start, at most by {:.4g}",
                                penetrations.moved_nodes, penetrations.largest_move);
    moved.item = "node";
    moved.count = penetrations.moved_nodes;
    if (penetrations.farthest_node >= 0) {
      moved.ids = {penetrations.farthest_node};
    }
    moved.numbers = {{"largest_move", penetrations.largest_move}};
  }
  for (const Penetration& p : list) {
    quality::Finding finding;
    finding.body = p.body;
    finding.other_body = p.other_body == p.body ? "" : p.other_body;
    if (p.count > 0) {
      finding.kind = "initial_penetration";
      finding.message = nearness_text(p);
      finding.cure = nearness_cure(p, penetrations.removed);
      finding.count = p.count;
      finding.numbers = {{"depth", p.depth}, {"contact_distance", p.contact_distance}};
      findings.push_back(finding);
    }
    if (p.crossings > 0) {
      finding.kind = "crossing";
      finding.message = crossing_text(p);
      finding.cure = crossing_cure;
      finding.count = p.crossings;
      finding.numbers = {};
      findings.push_back(finding);
    }
  }
  return findings;
}

}  // namespace fexp::app
