// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace fexp {

/// A list of at most `Capacity` items that is a plain value, for members of laws.
template <class T, std::size_t Capacity>
struct ShortList {
  static constexpr std::size_t capacity = Capacity;

  std::array<T, Capacity> items{};
  std::size_t count{};

  [[nodiscard]] const T* begin() const noexcept { return items.data(); }
  [[nodiscard]] const T* end() const noexcept { return items.data() + count; }
  [[nodiscard]] bool full() const noexcept { return count == Capacity; }
  /// The list must not be full.
  void append(const T& item) noexcept { items[count++] = item; }
};

}  // namespace fexp
