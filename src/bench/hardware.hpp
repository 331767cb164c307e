// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "bench/arithmetic.hpp"
#include "bench/rate.hpp"

namespace fexp::bench {

/// What so many threads of this machine can do at most, whatever the program. The best of the repetitions counts, as
/// other work on the machine can only slow them.
struct Roofs {
  int threads{};
  Rate triad;     ///< Bytes of a[i] = b[i] + s c[i]: 24 an element; what a cache reads before it writes is not counted
                  ///< [1/s]
  Rate fused;     ///< Flops of fused multiply-adds, two each; zero where the instruction set has none [1/s]
  Rate separate;  ///< Flops of multiplications and additions, as many of each, not fused [1/s]

  /// The highest rate of flops [1/s].
  [[nodiscard]] double peak_flops() const noexcept;
};

/// Sum of the largest caches of all processors that the system runs on; 0 when the system does not tell [byte].
[[nodiscard]] double last_cache_bytes();

/// Size of each of the three arrays of a triad that has to go through memory: `factor` times all largest caches
/// together, 64 MiB at least; but all three at most a quarter of the memory [byte].
[[nodiscard]] std::size_t triad_array_bytes(double caches, double factor);

/// Every repetition of each of the three takes about `seconds`.
[[nodiscard]] Roofs measure_roofs(const ArithmeticKernels& kernels, int threads, std::size_t array_bytes,
                                  double seconds);

}  // namespace fexp::bench
