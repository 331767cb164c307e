// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/build_bodies.hpp"
#include "model/build_checks.hpp"
#include "model/build_loads.hpp"
#include "model/build_rigid.hpp"
#include "model/held_directions.hpp"

namespace fexp::model {

namespace {

/// Degrees of freedom of one kind of condition as a mask.
unsigned mask_of(const std::vector<std::string>& dofs) {
  unsigned mask = 0;
  for (const std::string& dof : dofs) {
    mask |= 1U << static_cast<unsigned>(dof_index(dof));
  }
  return mask;
}

/// Whether all three translations, or rotations, of a mask are in it: then its axes do not matter.
bool holds_all(unsigned mask, bool angular) noexcept { return (mask >> (angular ? 3U : 0U) & 7U) == 7U; }

/// Part of a mask that can be told in the axes of the model.
unsigned axis_mask(const Fixed& fixed) {
  const unsigned mask = mask_of(fixed.dofs);
  if (are_model_axes(unit_axes(fixed.axes))) {
    return mask;
  }
  return (holds_all(mask, false) ? 0x07U : 0U) | (holds_all(mask, true) ? 0x38U : 0U);
}

void build_fixed(const Description& description, const Lookup& lookup, Model& model) {
  std::vector<std::uint8_t> masks(model.reference_position.size(), 0);
  for (const Fixed& fixed : description.fixed) {
    const unsigned mask = axis_mask(fixed);
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

/// Directions that are held at an angle to the axes of the model, sorted by node. Each is made orthogonal to what is
/// held at its node otherwise, so that conditions can be applied one after the other; one that adds nothing is left
/// out.
void build_oblique(const Description& description, const Lookup& lookup, Model& model) {
  constexpr double least_new = 1.0e-6;
  std::vector<ObliqueNode> given;
  for (const Fixed& fixed : description.fixed) {
    const std::array<Vec3d, 3> axes = unit_axes(fixed.axes);
    const unsigned mask = mask_of(fixed.dofs) & ~axis_mask(fixed);
    for (unsigned dof = 0; dof < 6; ++dof) {
      if ((mask >> dof & 1U) != 0) {
        for (const Index n : lookup.nodes(fixed.set)) {
          given.push_back({n, axes[dof % 3], dof >= 3});
        }
      }
    }
  }
  std::stable_sort(given.begin(), given.end(),
                   [](const ObliqueNode& a, const ObliqueNode& b) { return a.node < b.node; });
  for (const ObliqueNode& item : given) {
    const Vec3d rest = free_part(model, item.node, item.angular, item.direction);
    if (norm(rest) > least_new) {
      model.oblique.push_back({item.node, (1.0 / norm(rest)) * rest, item.angular});
    }
  }
}

/// Directions that differ by less than this share nothing but rounding.
constexpr double least_share = 1.0e-9;

/// The condition that already holds a direction of the node, or a part of it: of the fixed ones, or of the first
/// `count` prescribed ones.
std::string holder_of(const Description& description, const Lookup& lookup, std::size_t count, Index node, bool angular,
                      const Vec3d& direction) {
  const auto holds = [&](const std::string& set, const std::optional<LocalAxes>& given, unsigned mask) {
    const std::vector<Index>& nodes = lookup.nodes(set);
    const std::array<Vec3d, 3> axes = unit_axes(given);
    bool shared = false;
    for (unsigned axis = 0; axis < 3; ++axis) {
      shared = shared ||
               ((mask >> (angular ? axis + 3U : axis) & 1U) != 0 && std::abs(dot(axes[axis], direction)) > least_share);
    }
    return shared && std::binary_search(nodes.begin(), nodes.end(), node);
  };
  for (const Fixed& fixed : description.fixed) {
    if (holds(fixed.set, fixed.axes, mask_of(fixed.dofs))) {
      return fmt::format("fixed by set \"{}\"", fixed.set);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Prescribed& p = description.prescribed[i];
    if (holds(p.set, p.axes, 1U << static_cast<unsigned>(dof_index(p.dof)))) {
      return fmt::format("prescribed by set \"{}\"", p.set);
    }
  }
  return {};
}

/// A prescribed motion as it is for every node of its set.
PrescribedNode prescribed_of(const Prescribed& p, const Lookup& lookup) {
  const std::array<Vec3d, 3> axes = unit_axes(p.axes);
  const Index dof = dof_index(p.dof);
  PrescribedNode node;
  node.dof = static_cast<std::int8_t>(dof);
  node.kind = p.displacement   ? PrescribedKind::displacement
              : p.acceleration ? PrescribedKind::acceleration
                               : PrescribedKind::velocity;
  node.value = p.displacement ? *p.displacement : p.acceleration ? *p.acceleration : p.velocity.value_or(0.0);
  node.curve = lookup.curve(p.curve);
  node.oblique = !are_model_axes(axes);
  node.direction = axes[at(dof % 3)];
  return node;
}

/// Symmetry is left to check_symmetry.
void build_prescribed(const Description& description, const Lookup& lookup, Model& model, ErrorList& errors) {
  // Nodes with any condition on translations (1) and rotations (2), for which it is worth to look closer.
  std::vector<std::uint8_t> taken(model.reference_position.size(), 0);
  const auto take = [&](const std::string& set, unsigned mask) {
    const unsigned groups = ((mask & 0x07U) != 0 ? 1U : 0U) | ((mask & 0x38U) != 0 ? 2U : 0U);
    for (const Index n : lookup.nodes(set)) {
      taken[at(n)] = static_cast<std::uint8_t>(taken[at(n)] | groups);
    }
  };
  for (const Fixed& fixed : description.fixed) {
    take(fixed.set, mask_of(fixed.dofs));
  }
  for (std::size_t i = 0; i < description.prescribed.size(); ++i) {
    const Prescribed& p = description.prescribed[i];
    PrescribedNode item = prescribed_of(p, lookup);
    const unsigned group = item.dof >= 3 ? 2U : 1U;
    bool reported = false;
    for (const Index n : lookup.nodes(p.set)) {
      item.node = n;
      const std::string holder = reported || (taken[at(n)] & group) == 0
                                     ? ""
                                     : holder_of(description, lookup, i, n, item.dof >= 3, item.direction);
      if (!holder.empty()) {
        errors.add(p.place,
                   fmt::format("set \"{}\" prescribes {} of node {} of body \"{}\", which is already {}", p.set, p.dof,
                               model.node_label[at(n)], model.bodies[at(model.node_body[at(n)])].name, holder),
                   "one condition for each degree of freedom", "take the node out of one of the sets");
        reported = true;
      }
      model.prescribed.push_back(item);
    }
    take(p.set, 1U << static_cast<unsigned>(item.dof));
  }
  std::stable_sort(model.prescribed.begin(), model.prescribed.end(),
                   [](const PrescribedNode& a, const PrescribedNode& b) {
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

/// Range of a sorted list whose members' key lies in `keys`.
template <class Item, class Key>
IndexRange range_in(const std::vector<Item>& items, IndexRange keys, const Key& key) {
  const auto before = [&](const Item& item, Index limit) { return key(item) < limit; };
  const auto begin = std::lower_bound(items.begin(), items.end(), keys.begin, before);
  const auto end = std::lower_bound(begin, items.end(), keys.end, before);
  return {static_cast<Index>(begin - items.begin()), static_cast<Index>(end - items.begin())};
}

}  // namespace

void build_conditions(const Description& description, std::span<const Mesh> meshes, Model& model, ErrorList& errors) {
  const Lookup lookup(model);
  build_fixed(description, lookup, model);
  build_prescribed(description, lookup, model, errors);
  build_symmetry(description, lookup, model);
  build_oblique(description, lookup, model);
  build_loads(description, lookup, model);
  build_pressure(description, meshes, lookup, model, errors);
  check_symmetry(description, model, errors);
  build_rigid_conditions(description, lookup, model, errors);
  find_body_ranges(model);
}

void find_body_ranges(Model& model) {
  const auto node_of = [](const auto& item) { return item.node; };
  constexpr unsigned every_dof = 0x3FU;
  for (Body& body : model.bodies) {
    body.fixed = range_in(model.fixed, body.nodes, node_of);
    body.prescribed = range_in(model.prescribed, body.nodes, node_of);
    body.symmetry = range_in(model.symmetry, body.nodes, node_of);
    body.oblique = range_in(model.oblique, body.nodes, node_of);
    body.forces = range_in(model.forces, body.nodes, node_of);
    body.ties = range_in(model.ties.ties, body.nodes, node_of);
    body.tied_blocks = range_in(model.ties.blocks, body.blocks, [](const TiedBlock& b) { return b.block; });
    body.pressure = range_in(model.pressure, body.elements, [](const PressureLoad& p) { return p.element; });
    body.barrier = body.fixed.size() == body.nodes.size() &&
                   std::all_of(model.fixed.begin() + body.fixed.begin, model.fixed.begin() + body.fixed.end,
                               [&](const FixedNode& f) { return f.mask == every_dof; });
  }
}

}  // namespace fexp::model
