// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"

namespace fexp::model {

/// Planes, cylinders and spheres of the deck, in this order; settings of contact and curves are in the model already.
void build_walls(const Description& description, Model& model);

}  // namespace fexp::model
