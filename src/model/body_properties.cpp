// SPDX-License-Identifier: Apache-2.0
#include "model/body_properties.hpp"

namespace fexp::model {

namespace {

/// Moments of mass about the origin of a flat triangle with thickness.
struct Moments {
  double mass{};
  Vec3d first;
  std::array<double, 6> second{};  ///< integral of x x, y y, z z, x y, y z, z x over mass
};

std::array<double, 6> products(const Vec3d& v) {
  return {v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.y * v.z, v.z * v.x};
}

void add_scaled(double scale, const std::array<double, 6>& a, std::array<double, 6>& sum) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += scale * a[i];
  }
}

/// Exact: over a triangle the mean of x x^T is (sum of corner products + 9 x centroid products) / 12, and across the
/// thickness t the normal adds t^2 / 12.
Moments triangle_moments(const Model& model, Index element, const Vec3d& origin) {
  const auto& corners = model.triangle[at(element)];
  const std::array<Vec3d, 3> x{model.reference_position[at(corners[0])] - origin,
                               model.reference_position[at(corners[1])] - origin,
                               model.reference_position[at(corners[2])] - origin};
  const SectionData& section = model.section_of(element);
  const Vec3d centroid = (1.0 / 3.0) * (x[0] + x[1] + x[2]);
  const Vec3d normal = cross(x[1] - x[0], x[2] - x[0]);
  const double t = section.thickness;
  Moments m;
  const Body& body = model.bodies[at(model.blocks[at(model.element_block[at(element)])].body)];
  m.mass = body.density_factor * model.mass_factor(element) * section.density * t * model.reference_area[at(element)];
  m.first = m.mass * centroid;
  for (const Vec3d& corner : x) {
    add_scaled(m.mass / 12.0, products(corner), m.second);
  }
  add_scaled(0.75 * m.mass, products(centroid), m.second);
  add_scaled(m.mass * t * t / 12.0, products((1.0 / norm(normal)) * normal), m.second);
  return m;
}

/// `origin` near the elements keeps the digits that the shift to their centre would cost.
BodyProperties properties(const Model& model, IndexRange elements, IndexRange nodes) {
  BodyProperties result;
  for (Index n = nodes.begin; n < nodes.end; ++n) {
    result.box.include(model.reference_position[at(n)]);
  }
  const Vec3d origin = 0.5 * (result.box.low + result.box.high);
  Moments sum;
  for (Index e = elements.begin; e < elements.end; ++e) {
    const Moments m = triangle_moments(model, e, origin);
    sum.mass += m.mass;
    sum.first += m.first;
    add_scaled(1.0, m.second, sum.second);
  }
  for (const AddedNode& point : model.point_masses) {
    if (nodes.contains(point.node)) {
      const Vec3d x = model.reference_position[at(point.node)] - origin;
      sum.mass += point.mass;
      sum.first += point.mass * x;
      add_scaled(point.mass, products(x), sum.second);
      // As of a sphere: half of it in each of two directions makes the inertia about the third.
      add_scaled(0.5 * point.inertia, {1.0, 1.0, 1.0, 0.0, 0.0, 0.0}, sum.second);
    }
  }
  const Vec3d offset = (1.0 / sum.mass) * sum.first;
  add_scaled(-sum.mass, products(offset), sum.second);
  const auto& [xx, yy, zz, xy, yz, zx] = sum.second;
  result.mass = sum.mass;
  result.centre = origin + offset;
  result.inertia = {yy + zz, zz + xx, xx + yy, -xy, -yz, -zx};
  return result;
}

}  // namespace

BodyProperties body_properties(const Model& model, Index body) {
  return properties(model, model.bodies[at(body)].elements, model.bodies[at(body)].nodes);
}

BodyProperties total_properties(const Model& model) {
  return properties(model, {0, model.element_count()}, {0, model.node_count()});
}

}  // namespace fexp::model
