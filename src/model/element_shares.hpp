// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "model/model.hpp"

namespace fexp::model {

/// What elements bring to the nodes at their corners, and their critical steps, in the reference geometry and with the
/// density of their material, shape [elements] each.
struct ElementShares {
  std::vector<double> area;     ///< [length^2]
  std::vector<double> mass;     ///< Of one corner [mass]
  std::vector<double> inertia;  ///< Of one corner [mass*length^2]
  std::vector<double> step;     ///< [time]
};

/// Needs nodes, triangles, blocks, sections and run settings of the model.
[[nodiscard]] ElementShares element_shares(const Model& model);

}  // namespace fexp::model
