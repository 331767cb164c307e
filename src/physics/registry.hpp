// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "physics/j2_laws.hpp"
#include "physics/linear_elastic.hpp"

namespace fexp::physics {

/// Every material law the deck can name. A new law is added here and nowhere else.
using AnyMaterial = std::variant<LinearElastic, J2Linear, J2Power, J2Table, JohnsonCook>;

}  // namespace fexp::physics
