// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/step_kernel.hpp"

namespace fexp::solve::kernels {

CriticalStep smallest_step_avx512(const StepKernelArguments& k, Index begin, Index end) noexcept {
  return smallest_step<Pack<8>>(k, begin, end);
}

}  // namespace fexp::solve::kernels
