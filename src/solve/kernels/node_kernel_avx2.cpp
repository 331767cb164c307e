// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels/node_kernel.hpp"

namespace fexp::solve::kernels {

NodeKernelReport update_nodes_avx2(const NodeKernelArguments& k, const Index* nodes, Index begin, Index end) noexcept {
  return update_nodes<SixLanes<compiled_instruction_set>>(k, nodes, begin, end);
}

}  // namespace fexp::solve::kernels
