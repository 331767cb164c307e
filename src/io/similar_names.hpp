// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fexp::io {

/// The few of the known names that look like misspellings of the wanted one, the nearest first.
[[nodiscard]] std::vector<std::string> similar_names(std::string_view wanted, std::span<const std::string> known);

}  // namespace fexp::io
