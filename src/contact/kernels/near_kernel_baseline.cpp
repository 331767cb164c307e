// SPDX-License-Identifier: Apache-2.0
#include "contact/kernels/near_kernel.hpp"

namespace fexp::contact::kernels {

NearKernel near_baseline() noexcept { return {prepare<Pack<2>>, find_near<Pack<2>>}; }

}  // namespace fexp::contact::kernels
