// SPDX-License-Identifier: Apache-2.0
#include "contact/kernels/near_kernel.hpp"

namespace fexp::contact::kernels {

NearKernel near_avx512() noexcept { return {prepare<Pack<8>>, find_near<Pack<8>>}; }

}  // namespace fexp::contact::kernels
