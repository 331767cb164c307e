// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/errors.hpp"
#include "model/description.hpp"

namespace fexp::model {

/// What the ranges of single parameters of material laws do not tell.
void check_materials(const Description& description, ErrorList& errors);

}  // namespace fexp::model
