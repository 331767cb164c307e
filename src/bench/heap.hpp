// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp::bench {

/// What the program holds on the heap at present.
[[nodiscard]] double heap_bytes();

}  // namespace fexp::bench
