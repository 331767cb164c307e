// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace fexp {

/// Index of a node, element, body or block inside the model; 32 bits because elements store many of them.
using Index = std::int32_t;

/// Marks "none" where an Index may be absent (for example, no neighbour across a free edge).
inline constexpr Index no_index = -1;

/// Ids typed by kind, for interfaces where mixing them up would compile unnoticed (faults, reports).
enum class NodeId : Index {};
enum class ElementId : Index {};
enum class BodyId : Index {};

/// Contiguous index range [begin, end).
struct IndexRange {
  Index begin{};
  Index end{};

  [[nodiscard]] constexpr Index size() const noexcept { return end - begin; }
  [[nodiscard]] constexpr bool contains(Index i) const noexcept { return i >= begin && i < end; }
  friend constexpr bool operator==(const IndexRange&, const IndexRange&) = default;
};

/// Index -> container offset, without a sign-conversion cast at every subscript.
[[nodiscard]] constexpr std::size_t at(Index i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace fexp
