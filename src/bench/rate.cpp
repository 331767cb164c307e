// SPDX-License-Identifier: Apache-2.0
#include "bench/rate.hpp"

#include <algorithm>

namespace fexp::bench {

Rate rate_of(std::vector<double> measured) {
  if (measured.empty()) {
    return {};
  }
  std::ranges::sort(measured);
  const std::size_t count = measured.size();
  const double median = 0.5 * (measured[(count - 1) / 2] + measured[count / 2]);
  return {median, measured.back(), (measured.back() - measured.front()) / median};
}

Rate scaled(double factor, const Rate& rate) { return {factor * rate.median, factor * rate.best, rate.spread}; }

}  // namespace fexp::bench
