// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp {

/// Whether the processor runs what is compiled for an instruction set.
#if defined(__x86_64__)
[[nodiscard]] inline bool has_avx2() noexcept { return __builtin_cpu_supports("avx2") != 0; }
[[nodiscard]] inline bool has_avx512() noexcept {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
}
#endif

}  // namespace fexp
