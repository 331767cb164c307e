// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/mesh.hpp"

namespace fexp::io {

/// What the mesh readers share: collects nodes, triangles, parts and groups in the order of the file, then leaves out
/// what nothing uses.
class MeshBuilder {
 public:
  /// Most nodes or triangles: 3 x triangle + corner must fit an Index.
  static constexpr std::size_t most = 0x7fffffff / 3;

  std::vector<Vec3d> position;           ///< [length], shape [nodes]
  std::vector<std::int64_t> node_label;  ///< As in model::Mesh: shape [nodes], or empty.

  /// Index of the part of that name, made when new; triangles of no named part belong to part("").
  Index part(std::string_view name);
  /// Index of the node group of that name, made when new.
  std::size_t group(std::string_view name);
  void add_to_group(std::size_t group, Index node) { groups_[group].nodes.push_back(node); }
  void reserve_triangles(std::size_t count);
  void add_triangle(Index a, Index b, Index c, Index part, std::int64_t label);
  /// Two triangles, cut along the shorter diagonal (a-c when equal).
  void add_quadrilateral(Index a, Index b, Index c, Index d, Index part, std::int64_t label);
  [[nodiscard]] std::size_t triangles() const noexcept { return mesh_.triangle.size(); }
  [[nodiscard]] const model::Mesh& mesh() const noexcept { return mesh_; }

  /// The mesh: without unused nodes and parts and empty groups, with a node group for every named part. All corners
  /// must name nodes.
  [[nodiscard]] model::Mesh take();

 private:
  void renumber_nodes();
  void renumber_parts();
  void add_groups_of_parts();

  model::Mesh mesh_;  ///< Its position stays empty until taken.
  std::vector<std::string> part_names_;
  std::map<std::string, Index, std::less<>> part_of_name_;
  std::vector<model::NodeGroup> groups_;
  std::map<std::string, std::size_t, std::less<>> group_of_name_;
};

}  // namespace fexp::io
