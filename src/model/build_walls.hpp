// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/description.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Planes, cylinders and spheres of the deck, in this order; settings of contact and curves are in the model already.
void build_walls(const Description& description, Model& model);

/// Orthogonal unit vectors along which a wall with mass does not move. `direction`: normal of a plane or axis of a
/// cylinder, of any length.
[[nodiscard]] std::vector<Vec3d> held_directions(const RigidWall& wall, WallShape shape, const Vec3d& direction);

/// Gives every wall with mass a body of one node that carries it; all else of the model must be there.
void build_wall_bodies(const Description& description, Model& model);

}  // namespace fexp::model
