// SPDX-License-Identifier: Apache-2.0
#include "model/model.hpp"

#include <algorithm>

namespace fexp::model {

bool Model::can_touch(Index a, Index b) const noexcept {
  if (!contact.enabled || (a == b && !contact.self)) {
    return false;
  }
  return excluded_pairs.empty() ||
         !std::binary_search(excluded_pairs.begin(), excluded_pairs.end(), std::pair{std::min(a, b), std::max(a, b)});
}

double curve_value(const Model& model, Index index, double time) noexcept {
  if (index == no_index) {
    return 1.0;
  }
  const auto& points = model.curves[at(index)].points;
  const auto after = std::upper_bound(points.begin(), points.end(), time,
                                      [](double t, const std::array<double, 2>& p) { return t < p[0]; });
  if (after == points.begin()) {
    return points.front()[1];
  }
  if (after == points.end()) {
    return points.back()[1];
  }
  const auto& left = *(after - 1);
  const auto& right = *after;
  return left[1] + (right[1] - left[1]) * ((time - left[0]) / (right[0] - left[0]));
}

}  // namespace fexp::model
