// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/errors.hpp"
#include "model/condition_lookup.hpp"
#include "model/description.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Masses, centres and inertias of the bodies that the description calls rigid; nodal masses must be there.
void build_rigid_bodies(const Description& description, Model& model);

/// Turns conditions on all nodes of a rigid body into such on the body, unless they hold it altogether: then they stay
/// as they are, which makes it a barrier. Conditions on some of its nodes, and planes of symmetry, are errors. The
/// conditions of the nodes must be there, sorted.
void build_rigid_conditions(const Description& description, const Lookup& lookup, Model& model, ErrorList& errors);

/// Gives rigid bodies the masses of the nodes that are tied to them, which move with them.
void add_tied_masses(Model& model);

}  // namespace fexp::model
