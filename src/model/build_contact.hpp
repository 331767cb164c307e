// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/errors.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Settings of contact that contradict each other.
void check_contact(const ContactSettings& contact, ErrorList& errors);

/// Penalty stiffnesses of nodes, from their masses or from their elements.
void build_contact_stiffness(Model& model);

/// Which bodies do not touch, and the laws of those that do. Names of bodies that are not there are errors.
void build_contact_pairs(const Description& description, Model& model, ErrorList& errors);

}  // namespace fexp::model
