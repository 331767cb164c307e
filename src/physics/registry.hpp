// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "physics/linear_elastic.hpp"

namespace fexp::physics {

/// Every material law the deck can name. A new law is added here and nowhere else.
using AnyMaterial = std::variant<LinearElastic>;

}  // namespace fexp::physics
