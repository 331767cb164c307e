// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/step_kernel.hpp"

namespace fexp::solve::kernels {

CriticalStep smallest_step_scalar(const StepKernelArguments& k, Index begin, Index end) noexcept {
  return smallest_step<double>(k, begin, end);
}

}  // namespace fexp::solve::kernels
