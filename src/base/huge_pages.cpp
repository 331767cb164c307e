// SPDX-License-Identifier: Apache-2.0
#include "base/huge_pages.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace fexp {

void ask_for_huge_pages([[maybe_unused]] void* p, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(MADV_HUGEPAGE)
  // The rest of the last page may belong to others. A refusal is as good as not having asked.
  static_cast<void>(madvise(p, bytes / huge_page_bytes * huge_page_bytes, MADV_HUGEPAGE));
#endif
}

}  // namespace fexp
