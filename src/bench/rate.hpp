// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace fexp::bench {

/// Repetitions of every measurement.
inline constexpr int repetitions = 3;

/// A rate that was measured several times [1/s].
struct Rate {
  double median{};
  double best{};
  double spread{};  ///< (largest - smallest) / median [-]
};

/// Of `factor` things in the place of one.
[[nodiscard]] Rate scaled(double factor, const Rate& rate);

[[nodiscard]] Rate rate_of(std::vector<double> measured);

}  // namespace fexp::bench
