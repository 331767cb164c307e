// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"

namespace fexp::model {

/// What mass scaling gave one part of a described body, all its copies together.
struct AddedMass {
  std::string body;
  std::string part;
  double mass{};        ///< Of the part by its material [mass]
  double added{};       ///< [mass]
  Index elements{};     ///< That got any
  double largest{1.0};  ///< Largest mass of an element over that by its material [-]
};

/// The parts that got mass, in the order of the bodies.
[[nodiscard]] std::vector<AddedMass> added_masses(const Model& model);

/// More than this part of a part's mass is worth a warning.
inline constexpr double much_added_mass = 0.05;

}  // namespace fexp::model
