// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_builder.hpp"

#include <algorithm>
#include <utility>

namespace fexp::io {

namespace {

/// Sorts and removes repeats; large lists are marked in a table instead, which is faster.
void make_ascending(std::vector<Index>& nodes, std::size_t node_count) {
  if (nodes.size() < node_count / 8) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return;
  }
  std::vector<char> used(node_count, 0);
  for (const Index n : nodes) {
    used[at(n)] = 1;
  }
  nodes.clear();
  for (std::size_t n = 0; n < node_count; ++n) {
    if (used[n] != 0) {
      nodes.push_back(static_cast<Index>(n));
    }
  }
}

}  // namespace

Index MeshBuilder::part(std::string_view name) {
  const auto found = part_of_name_.find(name);
  if (found != part_of_name_.end()) {
    return found->second;
  }
  const auto index = static_cast<Index>(part_names_.size());
  part_names_.emplace_back(name);
  part_of_name_.emplace(name, index);
  return index;
}

std::size_t MeshBuilder::group(std::string_view name) {
  const auto found = group_of_name_.find(name);
  if (found != group_of_name_.end()) {
    return found->second;
  }
  groups_.push_back({std::string(name), {}});
  group_of_name_.emplace(name, groups_.size() - 1);
  return groups_.size() - 1;
}

void MeshBuilder::reserve_triangles(std::size_t count) {
  mesh_.triangle.reserve(count);
  mesh_.part.reserve(count);
  mesh_.triangle_label.reserve(count);
}

void MeshBuilder::add_triangle(Index a, Index b, Index c, Index part, std::int64_t label) {
  mesh_.triangle.push_back({a, b, c});
  mesh_.part.push_back(part);
  mesh_.triangle_label.push_back(label);
}

void MeshBuilder::add_quadrilateral(Index a, Index b, Index c, Index d, Index part, std::int64_t label) {
  const Vec3d ac = position[at(c)] - position[at(a)], bd = position[at(d)] - position[at(b)];
  if (dot(bd, bd) < dot(ac, ac)) {
    add_triangle(a, b, d, part, label);
    add_triangle(b, c, d, part, label);
  } else {
    add_triangle(a, b, c, part, label);
    add_triangle(a, c, d, part, label);
  }
}

void MeshBuilder::renumber_nodes() {
  std::vector<Index> new_index(position.size(), no_index);
  for (const auto& t : mesh_.triangle) {
    for (const Index n : t) {
      new_index[at(n)] = 0;
    }
  }
  Index used = 0;
  for (std::size_t n = 0; n < position.size(); ++n) {
    if (new_index[n] != no_index) {
      position[at(used)] = position[n];
      if (!node_label.empty()) {
        node_label[at(used)] = node_label[n];
      }
      new_index[n] = used++;
    }
  }
  position.resize(at(used));
  node_label.resize(std::min(node_label.size(), at(used)));
  for (auto& t : mesh_.triangle) {
    for (Index& n : t) {
      n = new_index[at(n)];
    }
  }
  for (model::NodeGroup& group : groups_) {
    for (Index& n : group.nodes) {
      n = new_index[at(n)];
    }
    std::erase(group.nodes, no_index);
  }
}

void MeshBuilder::renumber_parts() {
  std::vector<Index> new_index(part_names_.size(), no_index);
  mesh_.part_names.clear();
  for (Index& part : mesh_.part) {
    Index& renumbered = new_index[at(part)];
    if (renumbered == no_index) {
      renumbered = static_cast<Index>(mesh_.part_names.size());
      mesh_.part_names.push_back(part_names_[at(part)]);
    }
    part = renumbered;
  }
}

void MeshBuilder::add_groups_of_parts() {
  std::vector<std::size_t> group_of_part;
  for (const std::string& name : mesh_.part_names) {
    group_of_part.push_back(name.empty() ? groups_.size() : group(name));
  }
  for (std::size_t t = 0; t < mesh_.triangle.size(); ++t) {
    const Index part = mesh_.part[t];
    if (!mesh_.part_names[at(part)].empty()) {
      auto& nodes = groups_[group_of_part[at(part)]].nodes;
      nodes.insert(nodes.end(), mesh_.triangle[t].begin(), mesh_.triangle[t].end());
    }
  }
}

model::Mesh MeshBuilder::take() {
  renumber_nodes();
  renumber_parts();
  add_groups_of_parts();
  for (model::NodeGroup& group : groups_) {
    make_ascending(group.nodes, position.size());
    if (!group.nodes.empty()) {
      mesh_.node_groups.push_back(std::move(group));
    }
  }
  for (std::string& name : mesh_.part_names) {
    if (name.empty()) {
      name = "shell";
    }
  }
  mesh_.position = std::move(position);
  mesh_.node_label = std::move(node_label);
  return std::move(mesh_);
}

}  // namespace fexp::io
