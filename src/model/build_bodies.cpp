// SPDX-License-Identifier: Apache-2.0
#include "model/build_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/trigonometry.hpp"
#include "model/build_checks.hpp"
#include "model/mesh_order.hpp"
#include "model/topology.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

constexpr Index mesh_grain = 8192;

/// A rotation made ready: Rodrigues' formula about an axis through a point.
class Rotator {
 public:
  explicit Rotator(const Rotation& rotation)
      : axis_((1.0 / norm(rotation.axis)) * rotation.axis), point_(rotation.point) {
    // Quarter turns are exact, so that a plate turned upright lies in its plane and boxes find it there.
    const double angle = std::remainder(rotation.angle_degrees, 360.0);
    if (std::remainder(angle, 90.0) == 0.0) {
      cosine_ = angle == 0.0 ? 1.0 : std::abs(angle) == 180.0 ? -1.0 : 0.0;
      sine_ = angle == 90.0 ? 1.0 : angle == -90.0 ? -1.0 : 0.0;
    } else {
      cosine_ = cosine(angle * std::numbers::pi / 180.0);
      sine_ = sine(angle * std::numbers::pi / 180.0);
    }
  }

  [[nodiscard]] Vec3d operator()(const Vec3d& p) const {
    const Vec3d r = p - point_;
    return point_ + cosine_ * r + sine_ * cross(axis_, r) + ((1.0 - cosine_) * dot(axis_, r)) * axis_;
  }

 private:
  Vec3d axis_, point_;
  double cosine_{}, sine_{};
};

Index section_index(const Description& description, const std::string& name) {
  for (std::size_t i = 0; i < description.sections.size(); ++i) {
    if (description.sections[i].name == name) {
      return static_cast<Index>(i);
    }
  }
  return no_index;
}

/// One body's mesh, placed and ordered, ready to be copied into the model.
struct PlacedMesh {
  std::vector<Vec3d> position;
  std::vector<std::int64_t> node_label;
  std::vector<Triangle> triangle;   // sorted by section
  std::vector<Index> part;          // [triangles]
  std::vector<Index> section;       // [triangles]
  std::vector<std::int64_t> label;  // [triangles]
  std::vector<Triangle> neighbour;  // [triangles]
  std::vector<NodeGroup> groups;
};

std::string section_names(const Description& description) {
  std::vector<std::string> names;
  for (const Section& section : description.sections) {
    names.push_back(section.name);
  }
  return name_list(names);
}

/// True when the deck gives the part a section that is not there, which check_description has reported.
bool names_missing_section(const Description& description, const BodyDescription& body, const std::string& part) {
  std::string name = body.section;
  for (const PartSection& choice : body.parts) {
    name = choice.part == part ? choice.section : name;
  }
  return !name.empty() && section_index(description, name) == no_index;
}

/// Section of every part of the mesh, or an error for each part without one.
std::vector<Index> part_sections(const Description& description, const BodyDescription& body, const Mesh& mesh,
                                 ErrorList& errors) {
  std::vector<Index> sections(mesh.part_names.size(), section_index(description, body.section));
  std::vector<char> used(mesh.part_names.size(), 0);
  for (const Index part : mesh.part) {
    used[at(part)] = 1;
  }
  for (const PartSection& choice : body.parts) {
    const auto found = std::find(mesh.part_names.begin(), mesh.part_names.end(), choice.part);
    if (found == mesh.part_names.end()) {
      errors.add(choice.place, fmt::format("body \"{}\" has no part \"{}\"", body.name, choice.part),
                 name_list(mesh.part_names), "use one of the mesh's physical groups");
      continue;
    }
    sections[static_cast<std::size_t>(found - mesh.part_names.begin())] = section_index(description, choice.section);
  }
  for (std::size_t p = 0; p < sections.size(); ++p) {
    if (sections[p] == no_index && used[p] != 0 && !names_missing_section(description, body, mesh.part_names[p])) {
      errors.add(body.place, fmt::format("part \"{}\" of body \"{}\" has no section", mesh.part_names[p], body.name),
                 section_names(description), "set section for the whole body, or name the part in parts");
    }
  }
  return sections;
}

/// Gives the nodes of a placed mesh their numbers in the body.
void number_nodes(const Mesh& mesh, PlacedMesh& placed) {
  const std::vector<Index> number = node_numbers(mesh.position.size(), placed.triangle);
  const std::vector<Vec3d> position = std::move(placed.position);
  placed.position.resize(position.size());
  placed.node_label.resize(position.size());
  parallel::for_each(static_cast<Index>(position.size()), mesh_grain, [&](Index n) {
    placed.position[at(number[at(n)])] = position[at(n)];
    placed.node_label[at(number[at(n)])] = mesh.node_label.empty() ? n : mesh.node_label[at(n)];
  });
  parallel::for_each(static_cast<Index>(placed.triangle.size()), mesh_grain, [&](Index t) {
    for (Index& n : placed.triangle[at(t)]) {
      n = number[at(n)];
    }
  });
  placed.groups = mesh.node_groups;
  for (NodeGroup& group : placed.groups) {
    for (Index& n : group.nodes) {
      n = number[at(n)];
    }
    std::sort(group.nodes.begin(), group.nodes.end());
  }
}

PlacedMesh place_mesh(const BodyDescription& body, const Mesh& mesh, const Surface& surface,
                      const std::vector<Index>& sections) {
  PlacedMesh placed;
  placed.position.resize(mesh.position.size());
  const std::vector<Rotator> rotations(body.rotate.begin(), body.rotate.end());
  parallel::for_each(static_cast<Index>(mesh.position.size()), mesh_grain, [&](Index n) {
    Vec3d p = body.scale * mesh.position[at(n)];
    for (const Rotator& rotation : rotations) {
      p = rotation(p);
    }
    placed.position[at(n)] = p + body.translate;
  });
  std::vector<Index> order(surface.triangle.size());
  std::iota(order.begin(), order.end(), 0);
  const auto by_section = [&](Index a, Index b) {
    return sections[at(mesh.part[at(a)])] < sections[at(mesh.part[at(b)])];
  };
  if (!std::is_sorted(order.begin(), order.end(), by_section)) {
    std::stable_sort(order.begin(), order.end(), by_section);
  }
  for (auto begin = order.begin(); begin != order.end();) {
    const Index section = sections[at(mesh.part[at(*begin)])];
    const auto end =
        std::find_if(begin, order.end(), [&](Index t) { return sections[at(mesh.part[at(t)])] != section; });
    order_by_place(placed.position, surface.triangle, {begin, end});
    begin = end;
  }
  std::vector<Index> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[at(order[i])] = static_cast<Index>(i);
  }
  placed.triangle.resize(order.size());
  placed.neighbour.resize(order.size());
  placed.part.resize(order.size());
  placed.section.resize(order.size());
  placed.label.resize(order.size());
  parallel::for_each(static_cast<Index>(order.size()), mesh_grain, [&](Index i) {
    const Index t = order[at(i)];
    Triangle nodes = surface.triangle[at(t)], neighbours = surface.neighbour[at(t)];
    for (Index& neighbour : neighbours) {
      neighbour = neighbour == no_index ? no_index : place[at(neighbour)];
    }
    if (body.flip_normals) {
      turn(nodes, neighbours);
    }
    placed.triangle[at(i)] = nodes;
    placed.neighbour[at(i)] = neighbours;
    placed.part[at(i)] = mesh.part[at(t)];
    placed.section[at(i)] = sections[at(mesh.part[at(t)])];
    placed.label[at(i)] = mesh.triangle_label.empty() ? t : mesh.triangle_label[at(t)];
  });
  number_nodes(mesh, placed);
  return placed;
}

void append_blocks(const PlacedMesh& placed, Index first_element, Index body, Model& model) {
  const auto count = static_cast<Index>(placed.triangle.size());
  for (Index e = 0; e < count;) {
    ElementBlock block{first_element + e, 0, placed.section[at(e)], body};
    while (e < count && block.count < block_lanes && placed.section[at(e)] == block.section) {
      model.element_block.push_back(model.block_count());
      ++block.count;
      ++e;
    }
    model.blocks.push_back(block);
  }
}

void append_copy(const PlacedMesh& placed, const std::string& name, Index description_index,
                 const BodyDescription& description, const Vec3d& shift, Model& model) {
  Body body;
  body.name = name;
  body.family = description.name;
  body.description = description_index;
  const Index index = model.body_count(), first_node = model.node_count(), first_element = model.element_count();
  body.blocks.begin = model.block_count();
  for (const Vec3d& position : placed.position) {
    model.reference_position.push_back(position + shift);
  }
  model.node_body.insert(model.node_body.end(), placed.position.size(), index);
  model.node_label.insert(model.node_label.end(), placed.node_label.begin(), placed.node_label.end());
  const auto offset = [](const Triangle& t, Index by) {
    Triangle moved = t;
    for (Index& i : moved) {
      i = i == no_index ? no_index : i + by;
    }
    return moved;
  };
  for (std::size_t t = 0; t < placed.triangle.size(); ++t) {
    model.triangle.push_back(offset(placed.triangle[t], first_node));
    model.neighbour.push_back(offset(placed.neighbour[t], first_element));
  }
  model.element_part.insert(model.element_part.end(), placed.part.begin(), placed.part.end());
  model.element_label.insert(model.element_label.end(), placed.label.begin(), placed.label.end());
  append_blocks(placed, first_element, index, model);
  body.nodes = {first_node, model.node_count()};
  body.elements = {first_element, model.element_count()};
  body.blocks.end = model.block_count();
  model.bodies.push_back(std::move(body));
}

void reserve(std::size_t nodes, std::size_t elements, Model& model) {
  model.reference_position.reserve(nodes);
  model.node_body.reserve(nodes);
  model.node_label.reserve(nodes);
  model.triangle.reserve(elements);
  model.neighbour.reserve(elements);
  model.element_part.reserve(elements);
  model.element_label.reserve(elements);
  model.element_block.reserve(elements);
}

/// Far from the origin, coordinates lack the digits that tell a triangle's corners apart.
void check_reach(const BodyDescription& body, const Mesh& mesh, const PlacedMesh& placed, ErrorList& errors) {
  constexpr double most_edges = 1.0e9;  // Leaves positions within an edge some six digits.
  const Array array = body.array.value_or(Array{});
  const Vec3d last{(array.count[0] - 1) * array.pitch.x, (array.count[1] - 1) * array.pitch.y,
                   (array.count[2] - 1) * array.pitch.z};
  double reach = 0.0, edge = HUGE_VAL;
  for (const Vec3d& p : placed.position) {
    reach = std::max({reach, norm(p), norm(p + last)});
  }
  for (const Triangle& t : mesh.triangle) {
    for (std::size_t a = 0; a < 3; ++a) {
      edge = std::min(edge, body.scale * norm(mesh.position[at(t[(a + 1) % 3])] - mesh.position[at(t[a])]));
    }
  }
  if (!(reach <= most_edges * edge)) {
    errors.add(
        body.place,
        fmt::format("body \"{}\" reaches {:g} from the origin, its shortest edge is {:g}", body.name, reach, edge),
        fmt::format("at most {:g} edges from the origin", most_edges),
        "correct its translation, scale or pitch, or move the whole model to the origin");
  }
}

}  // namespace

BuiltBodies build_bodies(const Description& description, std::span<const Mesh> meshes, Model& model,
                         ErrorList& errors) {
  BuiltBodies built;
  built.groups.resize(description.bodies.size());
  double nodes = 0.0, elements = 0.0;
  for (std::size_t b = 0; b < description.bodies.size(); ++b) {
    const auto& array = description.bodies[b].array;
    const double copies = array ? static_cast<double>(array->count[0]) * array->count[1] * array->count[2] : 1.0;
    nodes += copies * static_cast<double>(meshes[b].position.size());
    elements += copies * static_cast<double>(meshes[b].triangle.size());
  }
  // Corners are numbered 3 x element + corner.
  constexpr Index most_nodes = std::numeric_limits<Index>::max() - 1, most_elements = most_nodes / 3;
  if (elements > most_elements || nodes > most_nodes) {
    errors.add(description.bodies.front().place,
               fmt::format("the model would have {:.0f} elements and {:.0f} nodes", elements, nodes),
               fmt::format("at most {} elements and {} nodes", most_elements, most_nodes),
               "use coarser meshes or smaller arrays");
    return built;
  }
  reserve(static_cast<std::size_t>(nodes), static_cast<std::size_t>(elements), model);
  for (std::size_t b = 0; b < description.bodies.size(); ++b) {
    const BodyDescription& body = description.bodies[b];
    const Mesh& mesh = meshes[b];
    model.part_names.push_back(mesh.part_names);
    const std::size_t before = errors.size();
    const Surface surface = check_mesh(mesh, body.mesh_place, body.name, errors);
    if (errors.size() != before) {
      continue;
    }
    const std::vector<Index> sections = part_sections(description, body, mesh, errors);
    if (errors.size() != before) {
      continue;
    }
    PlacedMesh placed = place_mesh(body, mesh, surface, sections);
    check_reach(body, mesh, placed, errors);
    const Array array = body.array.value_or(Array{});
    for (int k = 0; k < array.count[2]; ++k) {
      for (int j = 0; j < array.count[1]; ++j) {
        for (int i = 0; i < array.count[0]; ++i) {
          const std::string name = body.array ? fmt::format("{}[{},{},{}]", body.name, i, j, k) : body.name;
          append_copy(placed, name, static_cast<Index>(b), body,
                      {i * array.pitch.x, j * array.pitch.y, k * array.pitch.z}, model);
        }
      }
    }
    built.groups[b] = std::move(placed.groups);
    built.branched = built.branched || surface.branched;
  }
  return built;
}

}  // namespace fexp::model
