// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace fexp {

/// Of a huge page [bytes], and so the least that is worth one.
inline constexpr std::size_t huge_page_bytes = std::size_t{1} << 21;

/// Asks the system to back whole huge pages of [p, p + bytes) with such; `p` begins one. Whether it does changes
/// nothing but the time.
void ask_for_huge_pages(void* p, std::size_t bytes) noexcept;

}  // namespace fexp
