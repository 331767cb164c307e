// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/errors.hpp"
#include "model/description.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Lumped masses and inertias, areas and half thicknesses; each node gathers its own corners. With run.minimum_step
/// elements get the mass for it; `ratio`: by how much omega^2 is larger than theirs, shape [blocks], or empty.
void build_masses(const Description& description, Model& model, std::span<const double> ratio);

/// With run.minimum_step: puts into `ratio` by what ties raise omega^2 in blocks whose elements are too light for it.
/// True when any was lower than that. `to_the_bound`: by as much as ties ever do, so that no higher one follows.
[[nodiscard]] bool raise_ratios(const Model& model, bool to_the_bound, std::vector<double>& ratio);

/// Names the first node of each described body whose mass or penalty stiffness is no positive finite number.
void check_masses(const Description& description, const Model& model, ErrorList& errors);

}  // namespace fexp::model
