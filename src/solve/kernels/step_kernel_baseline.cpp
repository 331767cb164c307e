// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/step_kernel.hpp"

namespace fexp::solve::kernels {

CriticalStep smallest_step_baseline(const StepKernelArguments& k, Index begin, Index end) noexcept {
  // Several at a time even without wide instructions: the roots of an element are found one after the other, and the
  // processor waits for them.
  return smallest_step<Pack<model::block_lanes>>(k, begin, end);
}

}  // namespace fexp::solve::kernels
