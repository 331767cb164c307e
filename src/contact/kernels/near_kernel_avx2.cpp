// SPDX-License-Identifier: Apache-2.0
#include "contact/kernels/near_kernel.hpp"

namespace fexp::contact::kernels {

NearKernel near_avx2() noexcept { return {prepare<Pack<4>>, find_near<Pack<4>>}; }

}  // namespace fexp::contact::kernels
