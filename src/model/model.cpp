// SPDX-License-Identifier: Apache-2.0
#include "model/model.hpp"

#include <algorithm>
#include <cmath>

namespace fexp::model {

bool Model::can_touch(Index a, Index b) const noexcept {
  if (!contact.enabled || (a == b && !contact.self)) {
    return false;
  }
  return excluded_pairs.empty() ||
         !std::binary_search(excluded_pairs.begin(), excluded_pairs.end(), std::pair{std::min(a, b), std::max(a, b)});
}

Index Model::meshed_body_count() const noexcept {
  Index count = body_count();
  while (count > 0 && bodies[at(count - 1)].wall != no_index) {
    --count;
  }
  return count;
}

// sqrt(1 + xi^2) - xi, with the very value of one where there is no damping.
double Model::first_step() const noexcept {
  const double xi = run.stiffness_damping / first_critical_step;
  return run.safety * (first_critical_step * (1.0 / (std::sqrt(1.0 + xi * xi) + xi)));
}

Vec3d centre_of_mass(const Model& model, const Body& body) {
  Vec3d centre;
  for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
    centre += (model.mass[at(n)] / body.mass) * model.reference_position[at(n)];
  }
  return centre;
}

namespace {

using Points = std::vector<std::array<double, 2>>;

/// The first point later than a time.
Points::const_iterator point_after(const Points& points, double time) noexcept {
  return std::upper_bound(points.begin(), points.end(), time,
                          [](double t, const std::array<double, 2>& p) { return t < p[0]; });
}

/// Integral of a curve from its first point to a time, which may lie before it.
double area_to(const Model& model, Index index, double time) noexcept {
  const Points& points = model.curves[at(index)].points;
  const auto after = point_after(points, time);
  const auto left = after == points.begin() ? after : after - 1;
  return model.curve_areas[at(index)][static_cast<std::size_t>(left - points.begin())] +
         0.5 * (time - (*left)[0]) * ((*left)[1] + value_of(model.curves[at(index)], time));
}

}  // namespace

double value_of(const Curve& curve, double time) noexcept {
  const Points& points = curve.points;
  const auto after = point_after(points, time);
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

double curve_value(const Model& model, Index index, double time) noexcept {
  return index == no_index ? 1.0 : value_of(model.curves[at(index)], time);
}

double curve_slope(const Model& model, Index index, double time) noexcept {
  if (index == no_index) {
    return 0.0;
  }
  const Points& points = model.curves[at(index)].points;
  const auto after = point_after(points, time);
  const auto slope = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return (b[1] - a[1]) / (b[0] - a[0]);
  };
  const bool inside = after != points.begin() && after != points.end();
  const double right = inside ? slope(*(after - 1), *after) : 0.0;
  const bool corner = after != points.begin() && (*(after - 1))[0] == time;
  if (!corner) {
    return right;
  }
  const double left = after - 1 == points.begin() ? 0.0 : slope(*(after - 2), *(after - 1));
  return 0.5 * (left + right);
}

double curve_integral(const Model& model, Index index, double time) noexcept {
  return index == no_index ? time : area_to(model, index, time) - area_to(model, index, 0.0);
}

}  // namespace fexp::model
