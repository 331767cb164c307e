// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/errors.hpp"
#include "model/description.hpp"

namespace fexp::model {

/// A displacement that does not jump, as that would take a boundless speed. `name` says whose it is.
void check_displacement(const std::string& name, const std::string& curve_name, const std::vector<Curve>& curves,
                        const Place& place, ErrorList& errors);

/// Rigid walls have names of their own, directions, and one motion at most.
void check_walls(const Description& description, ErrorList& errors);

}  // namespace fexp::model
