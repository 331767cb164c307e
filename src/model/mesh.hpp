// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

namespace fexp::model {

/// Named nodes of a mesh (a physical group of any dimension).
struct NodeGroup {
  std::string name;
  std::vector<Index> nodes;  ///< Ascending, without repeats.
};

/// A triangle surface mesh as generated or read, before it becomes part of a model.
struct Mesh {
  std::vector<Vec3d> position;                   ///< Node positions [length], shape [nodes].
  std::vector<std::array<Index, 3>> triangle;    ///< Corner nodes, shape [triangles]; the order gives the normal.
  std::vector<Index> part;                       ///< Index into part_names, shape [triangles].
  std::vector<std::string> part_names{"shell"};  ///< Physical groups of the triangles.
  std::vector<NodeGroup> node_groups;            ///< Physical groups by their nodes, those of the triangles included.
  /// How the user's file names each triangle and node (1-based line or tag), for error messages and results;
  /// empty for generated meshes, whose ids are the indices.
  std::vector<std::int64_t> triangle_label;
  std::vector<std::int64_t> node_label;
};

}  // namespace fexp::model
