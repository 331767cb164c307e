// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/errors.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

struct BuiltBodies {
  /// Of each described body's mesh by the numbers that nodes have in the body, shape [described bodies].
  std::vector<std::vector<NodeGroup>> groups;
  bool branched{};  ///< More than two triangles meet at some edge
};

/// Appends every copy of every described body: nodes, elements, blocks, sections, initial velocities.
[[nodiscard]] BuiltBodies build_bodies(const Description& description, std::span<const Mesh> meshes, Model& model,
                                       ErrorList& errors);

/// Expands node sets, the set "all" first. `groups` are those that build_bodies returned.
void build_node_sets(const Description& description, std::span<const std::vector<NodeGroup>> groups, Model& model,
                     ErrorList& errors);

/// Puts point masses on nodes; node sets must be expanded.
void build_point_masses(const Description& description, Model& model);

/// Puts conditions and loads on nodes and elements, sorted, with each body's ranges. Node sets must be expanded;
/// `meshes` are those given to build_bodies.
void build_conditions(const Description& description, std::span<const Mesh> meshes, Model& model, ErrorList& errors);

/// Gives each body its ranges of conditions, loads and ties, and says which bodies are barriers.
void find_body_ranges(Model& model);

}  // namespace fexp::model
