// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::solve {

/// Takes components along prescribed directions out of vectors at the nodes of one body.
class FreePart {
 public:
  FreePart(const model::Model& model, Index body);

  /// Of a translation and a rotation of the node.
  void reduce(Index node, Vec3d& linear, Vec3d& angular) const;

 private:
  const model::Model& model_;
  IndexRange range_;
};

/// Takes all motion from a body at a step boundary but what is prescribed, and books the kinetic energy and the momenta
/// that this takes as those of damping are. Accelerations stay, so that the next step begins as one from rest does. The
/// velocities that the nodes of a rigid body have follow in that step.
void bring_to_rest(const model::Model& model, model::State& state, Index body);

}  // namespace fexp::solve
