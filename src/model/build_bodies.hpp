// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/errors.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Appends every copy of every described body: nodes, elements, blocks, sections, initial velocities.
void build_bodies(const Description& description, std::span<const Mesh> meshes, Model& model, ErrorList& errors);

/// Expands node sets and puts conditions and loads on nodes and elements, sorted, with each body's ranges. `meshes` are
/// those given to build_bodies.
void build_conditions(const Description& description, std::span<const Mesh> meshes, Model& model, ErrorList& errors);

}  // namespace fexp::model
