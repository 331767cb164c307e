// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace fexp {

/// Three components over a number type T (double, or a pack of lanes).
template <class T>
struct Vec3 {
  T x{};
  T y{};
  T z{};

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3d = Vec3<double>;

template <class T>
[[nodiscard]] constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> operator-(const Vec3<T>& a) noexcept {
  return {-a.x, -a.y, -a.z};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> operator*(const T& s, const Vec3<T>& a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
constexpr Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) noexcept {
  a = a + b;
  return a;
}
template <class T>
constexpr Vec3<T>& operator-=(Vec3<T>& a, const Vec3<T>& b) noexcept {
  a = a - b;
  return a;
}
template <class T>
[[nodiscard]] constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
[[nodiscard]] constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double norm(const Vec3d& a) noexcept { return std::sqrt(dot(a, a)); }

/// Axis-aligned box; empty until it is given a point.
struct Box {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  constexpr void include(const Vec3d& p) noexcept {
    low = {p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
    high = {p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
  }
  constexpr void include(const Box& b) noexcept {
    include(b.low);
    include(b.high);
  }
  [[nodiscard]] constexpr Box grown(double margin) const noexcept {
    return {{low.x - margin, low.y - margin, low.z - margin}, {high.x + margin, high.y + margin, high.z + margin}};
  }
  [[nodiscard]] constexpr bool contains(const Vec3d& p) const noexcept {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  }
  [[nodiscard]] constexpr bool overlaps(const Box& b) const noexcept {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y && low.z <= b.high.z &&
           b.low.z <= high.z;
  }
};

/// The axis along which a box extends farthest, the first of those that do.
[[nodiscard]] inline double Vec3d::*longest_axis(const Box& box) noexcept {
  const Vec3d extent = box.high - box.low;
  return extent.x >= extent.y && extent.x >= extent.z ? &Vec3d::x : extent.y >= extent.z ? &Vec3d::y : &Vec3d::z;
}

}  // namespace fexp
