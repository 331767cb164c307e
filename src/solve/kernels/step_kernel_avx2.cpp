// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/step_kernel.hpp"

namespace fexp::solve::kernels {

CriticalStep smallest_step_avx2(const StepKernelArguments& k, Index begin, Index end) noexcept {
  return smallest_step<Pack<4>>(k, begin, end);
}

}  // namespace fexp::solve::kernels
