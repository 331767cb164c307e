// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels.hpp"

#include "base/processor.hpp"
#include "solve/kernels/element_kernel.hpp"
#include "solve/kernels/node_kernel.hpp"
#include "solve/kernels/step_kernel.hpp"

namespace fexp::solve {

SelectedKernel select_element_kernel(KernelChoice choice) noexcept {
  const SelectedKernel scalar{kernels::update_blocks_scalar, kernels::update_nodes_scalar,
                              kernels::smallest_step_scalar, "scalar"};
  const SelectedKernel baseline{kernels::update_blocks_baseline, kernels::update_nodes_baseline,
                                kernels::smallest_step_baseline, "baseline"};
#if defined(__x86_64__)
  const SelectedKernel avx2{has_avx2() ? kernels::update_blocks_avx2 : nullptr, kernels::update_nodes_avx2,
                            kernels::smallest_step_avx2, "avx2"};
  const SelectedKernel avx512{has_avx512() ? kernels::update_blocks_avx512 : nullptr, kernels::update_nodes_avx512,
                              kernels::smallest_step_avx512, "avx512"};
#else
  const SelectedKernel avx2{nullptr, nullptr, nullptr, "avx2"};
  const SelectedKernel avx512{nullptr, nullptr, nullptr, "avx512"};
#endif
  switch (choice) {
    case KernelChoice::scalar:
      return scalar;
    case KernelChoice::baseline:
      return baseline;
    case KernelChoice::avx2:
      return avx2;
    case KernelChoice::avx512:
      return avx512;
    case KernelChoice::automatic:
      break;
  }
  if (avx512.elements != nullptr) {
    return avx512;
  }
  return avx2.elements != nullptr ? avx2 : baseline;
}

}  // namespace fexp::solve
