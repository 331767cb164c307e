// SPDX-License-Identifier: Apache-2.0
#include "physics/closest_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fexp::physics {
namespace {

using Triangle = std::array<Vec3d, 3>;

/// Distance to a segment in extended precision.
long double to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3<long double> ab{(long double)b.x - a.x, (long double)b.y - a.y, (long double)b.z - a.z};
  const Vec3<long double> ap{(long double)p.x - a.x, (long double)p.y - a.y, (long double)p.z - a.z};
  const long double t = std::clamp(dot(ap, ab) / dot(ab, ab), 0.0L, 1.0L);
  const Vec3<long double> r = ap - t * ab;
  return std::sqrt(dot(r, r));
}

/// The independent twin: the plane where the projection falls inside, else the best of three segments.
long double slow_distance(const Vec3d& p, const Triangle& t) {
  const auto wide = [](const Vec3d& v) { return Vec3<long double>{v.x, v.y, v.z}; };
  const auto x = wide(p), a = wide(t[0]), b = wide(t[1]), c = wide(t[2]);
  const auto n = cross(b - a, c - a);
  const bool inside =
      dot(cross(b - a, x - a), n) >= 0.0L && dot(cross(c - b, x - b), n) >= 0.0L && dot(cross(a - c, x - c), n) >= 0.0L;
  if (inside) {
    return std::abs(dot(x - a, n)) / std::sqrt(dot(n, n));
  }
  return std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
}

double largest_side(const Triangle& t) { return std::max({norm(t[1] - t[0]), norm(t[2] - t[1]), norm(t[0] - t[2])}); }

/// Checks the distance against the twin and that the parts of the result agree with each other.
void check(const Vec3d& p, const Triangle& t, double tolerance) {
  const ClosestPoint c = closest_point(p, t[0], t[1], t[2]);
  const double size = largest_side(t) + norm(p - t[0]);
  const double distance = std::sqrt(c.distance2);
  EXPECT_NEAR(distance, static_cast<double>(slow_distance(p, t)), tolerance * size);
  EXPECT_NEAR(c.weight[0] + c.weight[1] + c.weight[2], 1.0, 1e-15);
  for (const double w : c.weight) {
    EXPECT_GE(w, -1e-15);
    EXPECT_LE(w, 1.0);
  }
  const Vec3d foot = c.weight[0] * t[0] + c.weight[1] * t[1] + c.weight[2] * t[2];
  EXPECT_LE(norm(p - foot - c.offset), 1e-14 * size);
  EXPECT_EQ(c.feature, feature_of(c.weight));
}

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  Vec3d point(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }

 private:
  std::mt19937 random_;
};

Triangle random_triangle(Dice& dice) {
  for (;;) {
    const Triangle t{dice.point(1.0), dice.point(1.0), dice.point(1.0)};
    if (norm(cross(t[1] - t[0], t[2] - t[0])) > 0.1 * largest_side(t) * largest_side(t)) {
      return t;
    }
  }
}

TEST(closest_point, is_that_of_the_slow_twin_near_and_far) {
  Dice dice(1);
  for (int i = 0; i < 20000; ++i) {
    const Triangle t = random_triangle(dice);
    check(dice.point(2.0), t, 1e-14);
    check(dice.point(1.0e6), t, 1e-14);
    check(dice.number(0.0, 1.0) * t[0] + dice.number(0.0, 1.0) * t[1] + dice.number(-1.0, 1.0) * t[2], t, 1e-14);
  }
}

TEST(closest_point, is_that_of_the_slow_twin_on_slivers) {
  Dice dice(2);
  for (int i = 0; i < 20000; ++i) {
    const double width = std::pow(10.0, dice.number(-6.0, -1.0));
    const Vec3d direction = dice.point(1.0);
    const Triangle t{Vec3d{}, direction, dice.number(-0.2, 1.2) * direction + width * dice.point(1.0)};
    // The normal of a sliver is known to rounding over its width; so is the distance to its plane.
    const double slender = norm(cross(t[1], t[2])) / (largest_side(t) * largest_side(t));
    if (slender > 1e-8) {
      check(dice.point(1.5), t, 1e-14 + 1e-15 / slender);
    }
  }
}

/// Points on the border of two regions, by how the border is made: over an edge, or over a corner in the plane square
/// to one of its edges.
TEST(closest_point, is_right_on_both_sides_of_every_border_of_the_seven_regions) {
  Dice dice(3);
  for (int i = 0; i < 3000; ++i) {
    const Triangle t = random_triangle(dice);
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3d& from = t[a];
      const Vec3d& to = t[(a + 1) % 3];
      const Vec3d along = to - from;
      const Vec3d outward = cross(along, normal);
      const double height = dice.number(-1.0, 1.0), way = dice.number(0.0, 1.0);
      const Vec3d face_edge = from + way * along + height * normal;
      const Vec3d edge_corner = from + way * outward + height * normal;
      const Vec3d edge_other_corner = to + way * outward + height * normal;
      for (const double step : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
        for (const double sign : {-1.0, 1.0}) {
          check(face_edge + (sign * step) * outward, t, 1e-14);
          check(edge_corner + (sign * step) * along, t, 1e-14);
          check(edge_other_corner + (sign * step) * along, t, 1e-14);
        }
      }
      for (const Vec3d& p : {face_edge, edge_corner, edge_other_corner}) {
        for (const double end : {-HUGE_VAL, HUGE_VAL}) {
          check({std::nextafter(p.x, end), p.y, p.z}, t, 1e-14);
          check({p.x, std::nextafter(p.y, end), p.z}, t, 1e-14);
          check({p.x, p.y, std::nextafter(p.z, end)}, t, 1e-14);
        }
      }
    }
  }
}

TEST(closest_point, of_a_point_on_the_triangle_is_that_point) {
  Dice dice(4);
  for (int i = 0; i < 5000; ++i) {
    const Triangle t = random_triangle(dice);
    const double a = dice.number(0.0, 1.0), b = dice.number(0.0, 1.0 - a);
    const ClosestPoint inside = closest_point((1.0 - a - b) * t[0] + a * t[1] + b * t[2], t[0], t[1], t[2]);
    EXPECT_LE(std::sqrt(inside.distance2), 1e-14);
    EXPECT_NEAR(inside.weight[1], a, 1e-14);
    EXPECT_NEAR(inside.weight[2], b, 1e-14);
    for (std::size_t c = 0; c < 3; ++c) {
      const ClosestPoint corner = closest_point(t[c], t[0], t[1], t[2]);
      EXPECT_LE(corner.distance2, 1e-32);
      EXPECT_TRUE(is_corner(corner.feature));
      EXPECT_EQ(number_of(corner.feature), c);
      const ClosestPoint edge = closest_point((1.0 - a) * t[c] + a * t[(c + 1) % 3], t[0], t[1], t[2]);
      EXPECT_TRUE(is_edge(edge.feature));
      EXPECT_EQ(number_of(edge.feature), c);
    }
  }
}

TEST(closest_point, two_triangles_that_share_an_edge_name_it_alike_or_one_of_them_is_closer_by_more_than_rounding) {
  Dice dice(5);
  int faces = 0;
  for (int i = 0; i < 20000; ++i) {
    Triangle t = random_triangle(dice);
    const double fold = dice.number(-0.3, 0.3);
    const Vec3d opposite = t[0] + t[1] - t[2] + fold * cross(t[1] - t[0], t[2] - t[0]);
    const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
    const Vec3d inward = cross(normal, t[1] - t[0]);
    const double shift = std::pow(10.0, dice.number(-17.0, -3.0)) * (i % 2 == 0 ? 1.0 : -1.0);
    const Vec3d p = t[0] + dice.number(0.1, 0.9) * (t[1] - t[0]) + dice.number(-0.5, 0.5) * normal + shift * inward;
    const ClosestPoint one = closest_point(p, t[0], t[1], t[2]), two = closest_point(p, t[1], t[0], opposite);
    if (one.feature == Feature::face && two.feature == Feature::edge_0) {
      EXPECT_LT(one.distance2, two.distance2);
      ++faces;
    } else if (two.feature == Feature::face && one.feature == Feature::edge_0) {
      EXPECT_LT(two.distance2, one.distance2);
      ++faces;
    }
  }
  EXPECT_GT(faces, 1000);
}

}  // namespace
}  // namespace fexp::physics
