// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "physics/closest_lines.hpp"
#include "physics/closest_point.hpp"

/// A million pairs of a node and a triangle, and of two edges, with whole coordinates, against arithmetic without
/// rounding.
namespace fexp::physics {
namespace {

__extension__ using Whole = __int128;
using Point = std::array<Whole, 3>;

/// A square of a length as a fraction; the denominator is positive.
struct Fraction {
  Whole above{};
  Whole below{1};

  friend bool operator<(const Fraction& a, const Fraction& b) { return a.above * b.below < b.above * a.below; }
  [[nodiscard]] double value() const { return static_cast<double>(above) / static_cast<double>(below); }
};

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Whole times(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point across(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3d rounded(const Point& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

/// Coordinates of up to 400, often equal or nearly so, so that degenerate positions come up.
class Points {
 public:
  Point operator()() {
    Point p{};
    const int size = size_(random_) == 0 ? 3 : 400;
    for (Whole& x : p) {
      x = static_cast<int>(random_() % static_cast<unsigned>(2 * size + 1)) - size;
    }
    return p;
  }

 private:
  std::mt19937 random_{11};
  std::uniform_int_distribution<int> size_{0, 3};
};

Fraction to_edge(const Point& p, const Point& a, const Point& b) {
  const Point along = minus(b, a), from = minus(p, a);
  const Whole length2 = times(along, along), part = times(from, along);
  if (part <= 0 || length2 == 0) {
    return {times(from, from), 1};
  }
  if (part >= length2) {
    const Point end = minus(p, b);
    return {times(end, end), 1};
  }
  return {times(from, from) * length2 - part * part, length2};
}

Fraction to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point normal = across(minus(b, a), minus(c, a)), from = minus(p, a);
  const auto is_inside = [&](const Point& begin, const Point& end) {
    return times(across(minus(end, begin), minus(p, begin)), normal) >= 0;
  };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    const Whole height = times(from, normal);
    return {height * height, times(normal, normal)};
  }
  return std::min({to_edge(p, a, b), to_edge(p, b, c), to_edge(p, c, a)});
}

double size2(const std::array<Point, 4>& p) {
  double most = 0.0;
  for (const Point& a : p) {
    for (const Point& b : p) {
      const Point d = minus(a, b);
      most = std::max(most, static_cast<double>(times(d, d)));
    }
  }
  return most;
}

TEST(exact_distances, of_a_million_nodes_to_triangles) {
  Points points;
  double worst = 0.0;
  for (int i = 0; i < 1000000;) {
    const Point p = points(), a = points(), b = points(), c = points();
    const Point normal = across(minus(b, a), minus(c, a));
    if (times(normal, normal) == 0) {
      continue;
    }
    ++i;
    const double scale = size2({p, a, b, c});
    // Slivers turn their normal by rounding; the mesh checks refuse the worst.
    const double flatness = scale / std::sqrt(static_cast<double>(times(normal, normal)));
    const double exact = to_triangle(p, a, b, c).value();
    const double found = closest_point(rounded(p), rounded(a), rounded(b), rounded(c)).distance2;
    const double error = std::abs(found - exact) / (scale * flatness);
    worst = std::max(worst, error);
    if (error > 1e-14) {
      FAIL() << "pair " << i << ": " << found << " instead of " << exact;
    }
  }
  std::printf("worst error %.1e of the size's square, times the flatness of the triangle\n", worst);
}

TEST(exact_distances, of_a_million_pairs_of_edges_and_where_they_cross) {
  Points points;
  int crossed = 0;
  for (int i = 0; i < 1000000; ++i) {
    const Point a0 = points(), a1 = points(), b0 = points(), b1 = points();
    const Point along_a = minus(a1, a0), along_b = minus(b1, b0), between = minus(b0, a0);
    const Point normal = across(along_a, along_b);
    const Whole normal2 = times(normal, normal);
    const Whole first = times(across(between, along_b), normal), second = times(across(between, along_a), normal);
    const bool crosses = normal2 > 0 && first >= 0 && first <= normal2 && second >= 0 && second <= normal2;
    Fraction least = std::min({to_edge(a0, b0, b1), to_edge(a1, b0, b1), to_edge(b0, a0, a1), to_edge(b1, a0, a1)});
    const Whole height = times(between, normal);
    if (crosses) {
      least = {height * height, normal2};
      ++crossed;
    }
    const Vec3d p0 = rounded(a0), p1 = rounded(a1), q0 = rounded(b0), q1 = rounded(b1);
    const double scale = size2({a0, a1, b0, b1});
    ASSERT_NEAR(edge_distance2(p0, p1, q0, q1), least.value(), 1e-14 * scale) << "pair " << i;
    const ClosestOnLines c = closest_on_lines(p0, p1, q0, q1);
    ASSERT_EQ(c.sine2 > 0.0, normal2 > 0) << "pair " << i;
    if (normal2 > 0) {
      const auto below = static_cast<double>(normal2);
      const double part = static_cast<double>(first) / below, other = static_cast<double>(second) / below;
      ASSERT_NEAR(c.first, part, 1e-14 * (1.0 + std::abs(part))) << "pair " << i;
      ASSERT_NEAR(c.second, other, 1e-14 * (1.0 + std::abs(other))) << "pair " << i;
      ASSERT_NEAR(c.gap, static_cast<double>(height) / std::sqrt(below), 1e-14 * std::sqrt(scale)) << "pair " << i;
    }
  }
  EXPECT_GT(crossed, 50000);
}

}  // namespace
}  // namespace fexp::physics
