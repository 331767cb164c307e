// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "parallel/parallel.hpp"

int main() {
  const std::vector<double> value(100000, 1.0);
  double sum = 0.0;
  fexp::parallel::with_threads(4, [&] {
    for (int repetition = 0; repetition < 50; ++repetition) {
      fexp::parallel::for_each(100000, 100, [&](fexp::Index i) { sum += value[static_cast<std::size_t>(i)]; });
    }
  });
  return sum > 0.0 ? 0 : 1;
}
