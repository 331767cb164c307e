// SPDX-License-Identifier: Apache-2.0
#include "bench/heap.hpp"

#include <malloc.h>

namespace fexp::bench {

double heap_bytes() {
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks) + static_cast<double>(now.hblkhd);
}

}  // namespace fexp::bench
