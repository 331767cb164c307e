// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

namespace fexp::cluster {

/// All pairs of boxes that overlap or touch, each once with the lower index first, in an order that depends on the
/// boxes alone. Takes n log n time for n boxes that overlap few others each, whatever their sizes.
[[nodiscard]] std::vector<std::pair<Index, Index>> overlapping_pairs(std::span<const Box> boxes);

}  // namespace fexp::cluster
