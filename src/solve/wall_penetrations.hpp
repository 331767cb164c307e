// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "model/model.hpp"

namespace fexp::solve {

/// Nodes of a body that are inside a rigid wall before the start, so that it pushes them out at once.
struct WallPenetration {
  Index body{};
  Index wall{};
  std::int64_t count{};
  Index node{};               ///< That is in deepest, the lowest of several
  double depth{};             ///< Of that node's mid-surface and half thickness [length]
  double contact_distance{};  ///< Its half thickness [length]
};

/// By bodies, then walls. Bodies that are held altogether are none of a wall's business; what is nearer than its half
/// thickness by less than a thousandth of it counts as touching.
[[nodiscard]] std::vector<WallPenetration> find_wall_penetrations(const model::Model& model);

}  // namespace fexp::solve
