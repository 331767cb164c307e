// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/index.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Most elements of a patch, a compact piece of a body whose forces stay in the cache while they are summed: those on
/// its nodes, about half as many as elements, take 16 KiB.
inline constexpr Index patch_elements = 512;

/// Into how many patches consecutive blocks are cut.
[[nodiscard]] constexpr Index patch_count(Index blocks) noexcept {
  constexpr Index most = patch_elements / block_lanes;
  return (blocks + most - 1) / most;
}

/// First block of the i-th of `count` patches, of about the same size; for i = count the end.
[[nodiscard]] constexpr Index patch_begin(Index blocks, Index count, Index i) noexcept {
  return static_cast<Index>(std::int64_t{i} * blocks / count);
}

}  // namespace fexp::model
