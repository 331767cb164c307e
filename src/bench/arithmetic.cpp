// SPDX-License-Identifier: Apache-2.0
#include "bench/arithmetic.hpp"

#include "bench/kernels/arithmetic_kernel.hpp"

namespace fexp::bench {

ArithmeticKernels arithmetic_kernels(std::string_view element_kernel) noexcept {
#if defined(__x86_64__)
  if (element_kernel == "avx512") {
    return kernels::arithmetic_avx512();
  }
  if (element_kernel == "avx2") {
    ArithmeticKernels avx2 = kernels::arithmetic_avx2();
    // A processor may have the one without the other.
    if (__builtin_cpu_supports("fma") == 0) {
      avx2.fused = nullptr;
    }
    return avx2;
  }
#else
  static_cast<void>(element_kernel);
#endif
  return kernels::arithmetic_baseline();
}

}  // namespace fexp::bench
