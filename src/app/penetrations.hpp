// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/load.hpp"
#include "quality/finding.hpp"

/// Shells that are nearer before the start, to each other or to rigid walls, than their thicknesses allow.
namespace fexp::app {

/// Notes them in the case, and, where the deck asks for it, moves nodes apart and builds the model anew. Surfaces that
/// pass through each other are an error then.
void treat_penetrations(const std::vector<model::Mesh>& meshes, Case& loaded, ErrorList& errors);

/// A line for each pair of bodies, and for what was removed.
[[nodiscard]] std::vector<std::string> penetration_lines(const io::Summary::InitialPenetrations& penetrations);

/// The same as findings of a check.
[[nodiscard]] std::vector<quality::Finding> penetration_findings(const io::Summary::InitialPenetrations& penetrations);

}  // namespace fexp::app
