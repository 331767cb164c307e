// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "parallel/parallel.hpp"

int main() {
  using fexp::Index;
  constexpr Index outer = 4, inner = 25000;
  std::vector<double> a(outer * inner, 1.0), b(outer * inner);
  fexp::parallel::with_threads(4, [&] {
    for (int repetition = 0; repetition < 50; ++repetition) {
      fexp::parallel::for_each(outer, 1, [&](Index k) {
        fexp::parallel::for_each(inner, 100, [&](Index i) {
          const auto slot = static_cast<std::size_t>(k * inner + i);
          b[slot] = a[slot] + 1.0;
        });
      });
      fexp::parallel::for_each(outer * inner, 100, [&](Index i) {
        const auto slot = static_cast<std::size_t>(i);
        a[slot] = b[b.size() - 1 - slot];
      });
      a[5] += 1.0;
    }
  });
  return a[5] > 1.0 ? 0 : 1;
}
