// SPDX-License-Identifier: Apache-2.0
#include "io/convergence.hpp"

#include <cmath>

namespace fexp::io {

std::optional<double> order_towards(double reference, const MeshResult& coarse, const MeshResult& fine) {
  const double before = std::abs(coarse.result - reference), after = std::abs(fine.result - reference);
  if (!(before > 0.0 && after > 0.0)) {
    return std::nullopt;
  }
  return std::log(before / after) / std::log(fine.factor / coarse.factor);
}

bool refined_evenly(double coarse, double middle, double fine) noexcept { return coarse * fine == middle * middle; }

std::optional<Extrapolation> extrapolate(const std::array<MeshResult, 3>& meshes) {
  const auto& [coarse, middle, fine] = meshes;
  if (!refined_evenly(coarse.factor, middle.factor, fine.factor)) {
    return std::nullopt;
  }
  const double before = middle.result - coarse.result, after = fine.result - middle.result;
  const double shrinking = before / after;
  if (!(shrinking > 1.0 && std::isfinite(shrinking))) {
    return std::nullopt;
  }
  return Extrapolation{std::log(shrinking) / std::log(fine.factor / middle.factor),
                       fine.result + after / (shrinking - 1.0)};
}

}  // namespace fexp::io
