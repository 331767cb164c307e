// SPDX-License-Identifier: Apache-2.0
#include "base/pack.hpp"

namespace fexp {

/// Rounded once; found by the kernel's template through its argument.
static Pack<8> fused_multiply_add(Pack<8> a, Pack<8> b, Pack<8> c) noexcept {
  return Pack<8>(reinterpret_cast<Pack<8>::Native>(
      _mm512_fmadd_pd(reinterpret_cast<__m512d>(a.v), reinterpret_cast<__m512d>(b.v), reinterpret_cast<__m512d>(c.v))));
}

}  // namespace fexp

#include "bench/kernels/arithmetic_kernel.hpp"

namespace fexp::bench::kernels {

ArithmeticKernels arithmetic_avx512() noexcept { return arithmetic_of<Pack<8>>(); }

}  // namespace fexp::bench::kernels
