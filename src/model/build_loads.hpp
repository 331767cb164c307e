// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/errors.hpp"
#include "model/condition_lookup.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Puts gravity and nodal forces into the model, the forces sorted by node.
void build_loads(const Description& description, const Lookup& lookup, Model& model);

/// Puts pressure on elements, sorted. `meshes` are those the bodies were built from.
void build_pressure(const Description& description, std::span<const Mesh> meshes, const Lookup& lookup, Model& model,
                    ErrorList& errors);

}  // namespace fexp::model
