// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/vec3.hpp"

namespace fexp {

/// A rotation, as a quaternion of length one: the cosine of half the angle and its sine along the axis.
struct Quaternion {
  double w{1.0};
  Vec3d v{};

  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// First b, then a.
[[nodiscard]] constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) noexcept {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

/// The way back.
[[nodiscard]] constexpr Quaternion inverse(const Quaternion& q) noexcept { return {q.w, -q.v}; }

[[nodiscard]] inline Quaternion unit(const Quaternion& q) noexcept {
  const double scale = 1.0 / std::sqrt(q.w * q.w + dot(q.v, q.v));
  return {scale * q.w, scale * q.v};
}

[[nodiscard]] constexpr Vec3d rotated(const Quaternion& q, const Vec3d& x) noexcept {
  const Vec3d twice = 2.0 * cross(q.v, x);
  return x + q.w * twice + cross(q.v, twice);
}

/// The rotation by |vector| radians about the vector, of length one but for rounding after unit(). The tangent of half
/// the angle is cut after three terms of its continued fraction [AS64 4.3.94], a relative error of angle^6/100800.
[[nodiscard]] constexpr Quaternion rotation_by(const Vec3d& vector) noexcept {
  const double square = 0.25 * dot(vector, vector);
  return {1.0, (0.5 * (15.0 - square) / (15.0 - 6.0 * square)) * vector};
}

}  // namespace fexp
