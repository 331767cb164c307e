// SPDX-License-Identifier: Apache-2.0
#include "bench/kernels/arithmetic_kernel.hpp"

namespace fexp::bench::kernels {

ArithmeticKernels arithmetic_baseline() noexcept {
  using Lanes = Pack<2>;
  constexpr double lanes = Lanes::width;
  return {nullptr, separate_rounds<Lanes>, 0.0, 2.0 * separate_chains * lanes, triad<Lanes>};
}

}  // namespace fexp::bench::kernels
