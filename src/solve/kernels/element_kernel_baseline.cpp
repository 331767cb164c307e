// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/element_kernel.hpp"

namespace fexp::solve::kernels {

void update_blocks_baseline(const ElementKernelArguments& k, Index begin, Index end) noexcept {
  update_blocks<Pack<2>>(k, begin, end);
}

}  // namespace fexp::solve::kernels
