// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/crossings_report.hpp"

namespace fexp::app {

/// Looks at every frame of a results file for surfaces that have come through each other. Pairs of `exclude`, names of
/// bodies or of arrays, are left out. What is no results file throws OutputError, names that are not there InputErrors.
[[nodiscard]] CrossingsReport examine_crossings(const std::filesystem::path& results,
                                                const std::vector<std::pair<std::string, std::string>>& exclude);

}  // namespace fexp::app
