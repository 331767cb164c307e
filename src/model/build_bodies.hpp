// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/errors.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Appends every copy of every described body: nodes, elements, blocks, sections, initial velocities. Returns the node
/// groups of each described body's mesh by the numbers that nodes have in the body, shape [described bodies].
[[nodiscard]] std::vector<std::vector<NodeGroup>> build_bodies(const Description& description,
                                                               std::span<const Mesh> meshes, Model& model,
                                                               ErrorList& errors);

/// Expands node sets and puts conditions and loads on nodes and elements, sorted, with each body's ranges. `meshes` are
/// those given to build_bodies, `groups` what it returned.
void build_conditions(const Description& description, std::span<const Mesh> meshes,
                      std::span<const std::vector<NodeGroup>> groups, Model& model, ErrorList& errors);

}  // namespace fexp::model
