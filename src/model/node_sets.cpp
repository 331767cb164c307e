// SPDX-License-Identifier: Apache-2.0
#include "model/node_sets.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/build_checks.hpp"
#include "model/topology.hpp"

namespace fexp::model {

namespace {

void sort_unique(std::vector<Index>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

/// Bounding boxes of the first few bodies, for someone whose selection missed them.
std::string boxes_text(const Model& model, std::span<const Index> bodies) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(bodies.size(), most); ++i) {
    const Body& body = model.bodies[at(bodies[i])];
    Box box;
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      box.include(model.reference_position[at(n)]);
    }
    text += fmt::format("{}\"{}\" fills [{:.6g}, {:.6g}, {:.6g}] to [{:.6g}, {:.6g}, {:.6g}]", i == 0 ? "" : ", ",
                        body.name, box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
  }
  return text + (bodies.size() > most ? fmt::format(" and {} more bodies", bodies.size() - most) : "");
}

std::string selection_text(const NodeSet& set) {
  std::string text = set.bodies.empty() ? "all bodies" : "bodies " + name_list(set.bodies);
  if (set.boundary) {
    text += ", nodes on free edges";
  }
  if (set.box) {
    const Vec3d &l = set.box->low, &h = set.box->high;
    text += fmt::format(", box [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}]", l.x, l.y, l.z, h.x, h.y, h.z);
  }
  return text + (set.group.empty() ? "" : fmt::format(", group \"{}\"", set.group));
}

bool check_box(const NodeSet& set, ErrorList& errors) {
  const BoxSelection box = set.box.value_or(BoxSelection{});
  const Vec3d size = box.high - box.low;
  const bool good = size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0;
  if (!good) {
    errors.add(set.place, fmt::format("the box of node set \"{}\" has a low above its high", set.name),
               "low <= high in x, y and z", "exchange these coordinates of the corners");
  }
  return good;
}

/// Appends the body's nodes that satisfy the selections.
void append_selected(const NodeSet& set, const NodeGroup* group, const Model& model, const Body& body,
                     std::vector<Index>& nodes) {
  std::vector<Index> boundary;
  if (set.boundary) {
    boundary = boundary_nodes(std::span(model.triangle.begin() + body.elements.begin, at(body.elements.size())));
  }
  const auto take = [&](Index n) {
    const bool inside = !set.box || Box{set.box->low, set.box->high}.contains(model.reference_position[at(n)]);
    if (inside && (!set.boundary || std::binary_search(boundary.begin(), boundary.end(), n))) {
      nodes.push_back(n);
    }
  };
  if (group != nullptr) {
    for (const Index n : group->nodes) {
      take(body.nodes.begin + n);
    }
  } else {
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      take(n);
    }
  }
}

}  // namespace

BodyNames::BodyNames(const Model& model) : model_(model) {
  for (const Body& body : model.bodies) {
    if (families_.empty() || families_.back() != body.family) {
      families_.push_back(body.family);
    }
  }
}

std::vector<Index> BodyNames::find(const std::string& name) const {
  std::vector<Index> bodies;
  for (Index b = 0; b < model_.body_count(); ++b) {
    const Body& body = model_.bodies[at(b)];
    if (body.family == name || body.name == name) {
      bodies.push_back(b);
    }
  }
  return bodies;
}

std::vector<Index> BodyNames::find(std::span<const std::string> names, const Place& place, std::string_view user,
                                   ErrorList& errors) const {
  std::vector<Index> bodies;
  for (const std::string& name : names) {
    const std::vector<Index> found = find(name);
    if (found.empty()) {
      errors.add(place, fmt::format("{} names body \"{}\", which is not there", user, name), name_list(families_),
                 "correct the name");
    }
    bodies.insert(bodies.end(), found.begin(), found.end());
  }
  sort_unique(bodies);
  return bodies;
}

std::vector<Index> select_nodes(const NodeSet& set, std::span<const std::vector<NodeGroup>> body_groups,
                                const Model& model, const BodyNames& names, ErrorList& errors) {
  const std::size_t errors_before = errors.size();
  if (!check_box(set, errors)) {
    return {};
  }
  std::vector<Index> bodies;
  if (set.bodies.empty()) {
    for (Index b = 0; b < model.body_count(); ++b) {
      bodies.push_back(b);
    }
  } else {
    bodies = names.find(set.bodies, set.place, fmt::format("node set \"{}\"", set.name), errors);
  }
  std::vector<Index> nodes;
  std::vector<std::string> groups;
  bool group_found = set.group.empty();
  Index listed = no_index;
  for (const Index b : bodies) {
    const Body& body = model.bodies[at(b)];
    const NodeGroup* group = nullptr;
    for (const NodeGroup& candidate : body_groups[at(body.description)]) {
      if (candidate.name == set.group) {
        group = &candidate;
      }
      if (body.description != listed) {
        groups.push_back(candidate.name);
      }
    }
    listed = body.description;
    group_found = group_found || group != nullptr;
    if (set.group.empty() || group != nullptr) {
      append_selected(set, group, model, body, nodes);
    }
  }
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  if (errors.size() != errors_before) {
    return nodes;
  }
  if (!group_found) {
    errors.add(set.place, fmt::format("node set \"{}\": there is no physical group \"{}\"", set.name, set.group),
               name_list(groups), "use a group of the mesh");
  } else if (nodes.empty()) {
    errors.add(set.place, fmt::format("node set \"{}\" holds no node ({})", set.name, selection_text(set)),
               "a selection that holds a node; " + boxes_text(model, bodies), "widen the box, or choose other bodies");
  }
  return nodes;
}

}  // namespace fexp::model
