// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/errors.hpp"
#include "model/description.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Ties the nodes of the deck's ties to the closest triangles, with masses handed to their carriers. Conditions, masses
/// and rigid bodies must be there. Nodes tied to nodes that are held altogether are held instead: body ranges of
/// conditions have to be found again after this.
void build_ties(const Description& description, Model& model, ErrorList& errors);

/// TiedBlock::ratio is less than this.
inline constexpr double largest_tie_ratio = 2.0;

/// Gives ties with a strength the forces at which they break. Ties and conditions must be there.
void give_strengths(const Description& description, Model& model);

/// Hands the masses of tied nodes to carriers, and says in which blocks omega^2 is larger by that. Rigid bodies are
/// given theirs by add_tied_masses.
void weigh_ties(Model& model);

}  // namespace fexp::model
