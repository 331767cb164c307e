// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solve/kernels.hpp"

namespace fexp::test {

/// The kernels that this processor runs, the scalar one first.
inline std::vector<solve::SelectedKernel> kernels_here() {
  std::vector<solve::SelectedKernel> kernels;
  for (const solve::KernelChoice choice : {solve::KernelChoice::scalar, solve::KernelChoice::baseline,
                                           solve::KernelChoice::avx2, solve::KernelChoice::avx512}) {
    const solve::SelectedKernel kernel = solve::select_element_kernel(choice);
    if (kernel.elements != nullptr) {
      kernels.push_back(kernel);
    }
  }
  return kernels;
}

}  // namespace fexp::test
