// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::solve {

/// What comes to the momenta with the release of a node.
struct Release {
  Vec3d impulse;          ///< [force*time]
  Vec3d angular_impulse;  ///< About the origin [force*length*time]
};

/// Gives a tied node its own mass back, takes it from the carriers in State::moving, and has the node go on with the
/// velocity that it has as the end of the arm. As its mass was moved with the velocities of the carriers, node and
/// carriers then get the change of velocities, that of a rigid body, which keeps both momenta: of all such changes it
/// takes the least energy. What is returned besides is that the mass m comes from the point of the carriers to the end
/// of the arm r, m r x v; and all of the difference where conditions act on carriers, which then take it.
Release release_tied_node(const model::Model& model, const model::Tie& tie, model::State& state);

}  // namespace fexp::solve
