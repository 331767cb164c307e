// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/errors.hpp"
#include "model/description.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Index of a degree of freedom, or no_index.
[[nodiscard]] Index dof_index(std::string_view name);

/// Names for an error's list of accepted ones: the first few, and how many more there are.
[[nodiscard]] std::string name_list(std::span<const std::string> names);

/// Reports what is wrong with a description whatever its meshes are: names given twice or missing, references to
/// materials, sections, curves and node sets that are not there, vectors without direction, copies on top of each
/// other, curves whose times fall.
void check_description(const Description& description, ErrorList& errors);

/// Reports conditions that contradict each other at a node: a symmetry plane there and a degree of freedom that is
/// fixed or prescribed across it. Conditions must be expanded.
void check_symmetry(const Description& description, const Model& model, ErrorList& errors);

}  // namespace fexp::model
