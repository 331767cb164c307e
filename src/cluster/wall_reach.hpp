// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vec3.hpp"
#include "model/model.hpp"

namespace fexp::cluster {

/// Whether a wall whose point is anywhere in the box `points` may act on something anywhere in the box `body`
/// [length]. Never false where it may; a box that is near enough to a cylinder or a sphere may count as touching it.
[[nodiscard]] bool may_reach(const model::Wall& wall, const Box& points, const Box& body) noexcept;

}  // namespace fexp::cluster
