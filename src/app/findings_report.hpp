// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/trial.hpp"
#include "quality/finding.hpp"

namespace fexp::app {

/// What is allowed but seldom meant: of the mesh, and of how the trial started and how often output is written.
/// Warnings first. `meshes` are those the model was built from.
[[nodiscard]] std::vector<quality::Finding> all_findings(const Case& loaded, const std::vector<model::Mesh>& meshes,
                                                         const Trial& trial);

/// A line for each.
[[nodiscard]] std::string findings_text(const std::vector<quality::Finding>& findings);

[[nodiscard]] nlohmann::ordered_json findings_json(const std::vector<quality::Finding>& findings);

}  // namespace fexp::app
