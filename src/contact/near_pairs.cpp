// SPDX-License-Identifier: Apache-2.0
#include "contact/near_pairs.hpp"

#include <vector>

#include "base/processor.hpp"
#include "contact/kernels/near_kernel.hpp"

namespace fexp::contact {

std::span<const NearKernel> near_kernels() {
  static const std::vector<NearKernel> kernels = [] {
    std::vector<NearKernel> made{kernels::near_baseline()};
#if defined(__x86_64__)
    if (has_avx2()) {
      made.push_back(kernels::near_avx2());
    }
    if (has_avx512()) {
      made.push_back(kernels::near_avx512());
    }
#endif
    return made;
  }();
  return kernels;
}

}  // namespace fexp::contact
