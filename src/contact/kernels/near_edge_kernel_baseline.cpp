// SPDX-License-Identifier: Apache-2.0
#include "contact/kernels/near_edge_kernel.hpp"

namespace fexp::contact::kernels {

NearEdgeKernel near_edges_baseline() noexcept { return find_near_edges<Pack<2>>; }

}  // namespace fexp::contact::kernels
