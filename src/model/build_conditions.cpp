// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "model/build_bodies.hpp"
#include "model/build_checks.hpp"
#include "model/node_sets.hpp"

namespace fexp::model {

namespace {

/// Looks sets and curves up by name while conditions are expanded; check_description has found them all.
class Lookup {
 public:
  explicit Lookup(const Model& model) : model_(model) {}

  [[nodiscard]] const std::vector<Index>& nodes(const std::string& set) const {
    const auto found = std::find_if(model_.node_sets.begin(), model_.node_sets.end(),
                                    [&](const NamedNodes& named) { return named.name == set; });
    assert(found != model_.node_sets.end());
    return found->nodes;
  }
  /// The curve of that name; none for an empty name.
  [[nodiscard]] Index curve(const std::string& name) const {
    const auto found = std::find_if(model_.curves.begin(), model_.curves.end(),
                                    [&](const Curve& curve) { return curve.name == name; });
    assert(name.empty() || found != model_.curves.end());
    return name.empty() ? no_index : static_cast<Index>(found - model_.curves.begin());
  }

 private:
  const Model& model_;
};

void build_fixed(const Description& description, const Lookup& lookup, Model& model) {
  std::vector<std::uint8_t> masks(model.reference_position.size(), 0);
  for (const Fixed& fixed : description.fixed) {
    unsigned mask = 0;
    for (const std::string& dof : fixed.dofs) {
      mask |= 1U << static_cast<unsigned>(dof_index(dof));
    }
    for (const Index n : lookup.nodes(fixed.set)) {
      masks[at(n)] = static_cast<std::uint8_t>(masks[at(n)] | mask);
    }
  }
  for (Index n = 0; n < model.node_count(); ++n) {
    if (masks[at(n)] != 0) {
      model.fixed.push_back({n, masks[at(n)]});
    }
  }
}

/// The condition that already holds degree of freedom `dof` of the node: of the fixed ones, or of the first `count`
/// prescribed ones.
std::string holder_of(const Description& description, const Lookup& lookup, std::size_t count, Index node, Index dof) {
  const auto holds = [&](const std::string& set) {
    const std::vector<Index>& nodes = lookup.nodes(set);
    return std::binary_search(nodes.begin(), nodes.end(), node);
  };
  for (const Fixed& fixed : description.fixed) {
    if (std::find(fixed.dofs.begin(), fixed.dofs.end(), dof_names[at(dof)]) != fixed.dofs.end() && holds(fixed.set)) {
      return fmt::format("fixed by set \"{}\"", fixed.set);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Prescribed& p = description.prescribed[i];
    if (dof_index(p.dof) == dof && holds(p.set)) {
      return fmt::format("prescribed by set \"{}\"", p.set);
    }
  }
  return {};
}

void build_prescribed(const Description& description, const Lookup& lookup, Model& model, ErrorList& errors) {
  std::vector<std::uint8_t> held(model.reference_position.size(), 0);
  for (const FixedNode& fixed : model.fixed) {
    held[at(fixed.node)] = fixed.mask;
  }
  for (std::size_t i = 0; i < description.prescribed.size(); ++i) {
    const Prescribed& p = description.prescribed[i];
    const Index dof = dof_index(p.dof);
    const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(dof));
    const Index curve = lookup.curve(p.curve);
    bool reported = false;
    for (const Index n : lookup.nodes(p.set)) {
      if ((held[at(n)] & bit) != 0 && !reported) {
        errors.add(p.place,
                   fmt::format("set \"{}\" prescribes {} of node {} of body \"{}\", which is already {}", p.set, p.dof,
                               model.node_label[at(n)], model.bodies[at(model.node_body[at(n)])].name,
                               holder_of(description, lookup, i, n, dof)),
                   "one condition for each degree of freedom", "take the node out of one of the sets");
        reported = true;
      }
      held[at(n)] = static_cast<std::uint8_t>(held[at(n)] | bit);
      model.prescribed.push_back({n, static_cast<std::int8_t>(dof), p.velocity, curve});
    }
  }
  std::sort(model.prescribed.begin(), model.prescribed.end(), [](const PrescribedNode& a, const PrescribedNode& b) {
    return a.node != b.node ? a.node < b.node : a.dof < b.dof;
  });
}

/// Planes of symmetry as given, sorted by node. Where planes meet, a later normal is made orthogonal to the earlier
/// ones, so that the constraints can be applied one after the other; one that adds nothing is left out.
void build_symmetry(const Description& description, const Lookup& lookup, Model& model) {
  constexpr double least_new = 1.0e-6;  // sine of the angle below which two planes are one
  std::vector<SymmetryNode> given;
  for (const Symmetry& symmetry : description.symmetry) {
    const Vec3d normal = (1.0 / norm(symmetry.normal)) * symmetry.normal;
    for (const Index n : lookup.nodes(symmetry.set)) {
      given.push_back({n, normal});
    }
  }
  std::stable_sort(given.begin(), given.end(),
                   [](const SymmetryNode& a, const SymmetryNode& b) { return a.node < b.node; });
  std::size_t first = 0;  // of this node
  for (const SymmetryNode& plane : given) {
    if (model.symmetry.empty() || model.symmetry.back().node != plane.node) {
      first = model.symmetry.size();
      model.symmetry.push_back(plane);
      continue;
    }
    Vec3d rest = plane.normal;
    for (std::size_t i = first; i < model.symmetry.size(); ++i) {
      rest -= dot(rest, model.symmetry[i].normal) * model.symmetry[i].normal;
    }
    if (norm(rest) > least_new) {
      model.symmetry.push_back({plane.node, (1.0 / norm(rest)) * rest});
    }
  }
}

void build_loads(const Description& description, const Lookup& lookup, Model& model) {
  for (const Gravity& gravity : description.gravity) {
    model.gravity.push_back({gravity.acceleration, lookup.curve(gravity.curve)});
  }
  for (const NodalForce& force : description.forces) {
    const std::vector<Index>& nodes = lookup.nodes(force.set);
    const double share = force.total && !nodes.empty() ? 1.0 / static_cast<double>(nodes.size()) : 1.0;
    const Index curve = lookup.curve(force.curve);
    for (const Index n : nodes) {
      model.forces.push_back({n, share * force.force, share * force.moment, curve});
    }
  }
  std::stable_sort(model.forces.begin(), model.forces.end(),
                   [](const NodeLoad& a, const NodeLoad& b) { return a.node < b.node; });
}

void build_pressure(const Description& description, std::span<const Mesh> meshes, const BodyNames& names,
                    const Lookup& lookup, Model& model, ErrorList& errors) {
  for (const Pressure& pressure : description.pressure) {
    const Index curve = lookup.curve(pressure.curve);
    const std::size_t before = model.pressure.size(), errors_before = errors.size();
    std::vector<std::string> known;
    for (const Index b : names.find(pressure.bodies, pressure.place, "a pressure", errors)) {
      const Body& body = model.bodies[at(b)];
      const std::vector<std::string>& parts = meshes[at(body.description)].part_names;
      Index part = no_index;
      for (std::size_t p = 0; p < parts.size(); ++p) {
        part = parts[p] == pressure.part ? static_cast<Index>(p) : part;
        if (std::find(known.begin(), known.end(), parts[p]) == known.end()) {
          known.push_back(parts[p]);
        }
      }
      for (Index e = body.elements.begin; e < body.elements.end; ++e) {
        if (pressure.part.empty() || model.element_part[at(e)] == part) {
          model.pressure.push_back({e, pressure.value, curve});
        }
      }
    }
    if (model.pressure.size() == before && errors.size() == errors_before) {
      errors.add(pressure.place,
                 pressure.bodies.empty()
                     ? "a pressure names no body"
                     : fmt::format("a pressure loads no face: there is no part \"{}\"", pressure.part),
                 name_list(pressure.bodies.empty() ? names.families() : known),
                 pressure.bodies.empty() ? "name the bodies it loads" : "correct the part or the bodies");
    }
  }
  std::stable_sort(model.pressure.begin(), model.pressure.end(),
                   [](const PressureLoad& a, const PressureLoad& b) { return a.element < b.element; });
}

/// Range of a sorted list whose members' key lies in `keys`.
template <class Item, class Key>
IndexRange range_in(const std::vector<Item>& items, IndexRange keys, const Key& key) {
  const auto before = [&](const Item& item, Index limit) { return key(item) < limit; };
  const auto begin = std::lower_bound(items.begin(), items.end(), keys.begin, before);
  const auto end = std::lower_bound(begin, items.end(), keys.end, before);
  return {static_cast<Index>(begin - items.begin()), static_cast<Index>(end - items.begin())};
}

}  // namespace

void build_conditions(const Description& description, std::span<const Mesh> meshes,
                      std::span<const std::vector<NodeGroup>> groups, Model& model, ErrorList& errors) {
  NamedNodes all{"all", {}};
  for (Index n = 0; n < model.node_count(); ++n) {
    all.nodes.push_back(n);
  }
  model.node_sets.push_back(std::move(all));
  const BodyNames names(model);
  for (const NodeSet& set : description.node_sets) {
    model.node_sets.push_back({set.name, select_nodes(set, groups, model, names, errors)});
  }
  const Lookup lookup(model);
  build_fixed(description, lookup, model);
  build_prescribed(description, lookup, model, errors);
  build_symmetry(description, lookup, model);
  build_loads(description, lookup, model);
  build_pressure(description, meshes, names, lookup, model, errors);
  check_symmetry(description, model, errors);

  const auto node_of = [](const auto& item) { return item.node; };
  constexpr unsigned every_dof = 0x3FU;
  for (Body& body : model.bodies) {
    body.fixed = range_in(model.fixed, body.nodes, node_of);
    body.prescribed = range_in(model.prescribed, body.nodes, node_of);
    body.symmetry = range_in(model.symmetry, body.nodes, node_of);
    body.forces = range_in(model.forces, body.nodes, node_of);
    body.pressure = range_in(model.pressure, body.elements, [](const PressureLoad& p) { return p.element; });
    body.barrier = body.fixed.size() == body.nodes.size() &&
                   std::all_of(model.fixed.begin() + body.fixed.begin, model.fixed.begin() + body.fixed.end,
                               [&](const FixedNode& f) { return f.mask == every_dof; });
  }
}

}  // namespace fexp::model
