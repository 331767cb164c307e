// SPDX-License-Identifier: Apache-2.0
#include "base/pack.hpp"

namespace fexp {

/// Rounded once; found by the kernel's template through its argument.
static Pack<4> fused_multiply_add(Pack<4> a, Pack<4> b, Pack<4> c) noexcept {
  return Pack<4>(reinterpret_cast<Pack<4>::Native>(
      _mm256_fmadd_pd(reinterpret_cast<__m256d>(a.v), reinterpret_cast<__m256d>(b.v), reinterpret_cast<__m256d>(c.v))));
}

}  // namespace fexp

#include "bench/kernels/arithmetic_kernel.hpp"

namespace fexp::bench::kernels {

ArithmeticKernels arithmetic_avx2() noexcept { return arithmetic_of<Pack<4>>(); }

}  // namespace fexp::bench::kernels
