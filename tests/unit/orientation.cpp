// SPDX-License-Identifier: Apache-2.0
#include "base/orientation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

#include "base/index.hpp"

namespace fexp::exact_signs {
namespace {

__extension__ using Wide = __int128;

using Whole = std::array<std::int64_t, 3>;

Vec3d real(const Whole& p) { return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}; }

std::array<Wide, 3> less(const Whole& a, const Whole& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

std::array<Wide, 3> product(const std::array<Wide, 3>& a, const std::array<Wide, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// In whole numbers, where nothing is rounded.
int whole_orientation(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  const std::array<Wide, 3> n = product(less(b, a), less(c, a)), w = less(d, a);
  return sign(n[0] * w[0] + n[1] * w[1] + n[2] * w[2]);
}

/// Four points of which the last is in the plane of the others, or one unit off it, with coordinates of some 2^37.
class NearlyFlat {
 public:
  explicit NearlyFlat(unsigned seed) : random_(seed) {}

  std::array<Whole, 4> draw() {
    std::array<Whole, 4> p;
    std::uniform_int_distribution<std::int64_t> far(-(1LL << 36), 1LL << 36), near(-1, 1), few(-3, 3);
    for (std::size_t i = 0; i < 3; ++i) {
      p[0][i] = far(random_);
      p[1][i] = p[0][i] + far(random_) / 8;
      p[2][i] = p[0][i] + far(random_) / 8;
    }
    const std::int64_t s = few(random_), t = few(random_);
    for (std::size_t i = 0; i < 3; ++i) {
      p[3][i] = p[0][i] + s * (p[1][i] - p[0][i]) + t * (p[2][i] - p[0][i]) + near(random_) * near(random_);
    }
    return p;
  }

 private:
  std::mt19937 random_;
};

TEST(orientation, has_the_sign_of_whole_numbers_however_flat_four_points_are) {
  NearlyFlat flat(1);
  std::array<int, 3> seen{};
  for (int i = 0; i < 20000; ++i) {
    const std::array<Whole, 4> p = flat.draw();
    const int expected = whole_orientation(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(orientation(real(p[0]), real(p[1]), real(p[2]), real(p[3])), expected);
    ASSERT_EQ(orientation(real(p[0]), real(p[2]), real(p[1]), real(p[3])), -expected);
    ASSERT_EQ(orientation(real(p[3]), real(p[1]), real(p[2]), real(p[0])), -expected);
    ++seen[at(expected + 1)];
  }
  EXPECT_GT(seen[0], 1000);
  EXPECT_GT(seen[1], 1000);
  EXPECT_GT(seen[2], 1000);
}

TEST(orientation, of_clear_cases_is_the_side_of_the_normal) {
  const Vec3d a{0.0, 0.0, 0.0}, b{1.0, 0.0, 0.0}, c{0.0, 1.0, 0.0};
  EXPECT_EQ(orientation(a, b, c, {9.0, 9.0, 0.1}), 1);
  EXPECT_EQ(orientation(a, b, c, {9.0, 9.0, -0.1}), -1);
  EXPECT_EQ(orientation(a, b, c, {9.0, 9.0, 0.0}), 0);
  EXPECT_EQ(orientation(a, b, c, {0.0, 0.0, 1e-90}), 1);
}

TEST(orientation, of_a_moved_point_is_that_of_one_moved_by_a_little) {
  NearlyFlat flat(2);
  int decided = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::array<Whole, 4> p = flat.draw();
    const int exact = whole_orientation(p[0], p[1], p[2], p[3]);
    const int moved = moved_orientation(real(p[0]), real(p[1]), real(p[2]), real(p[3]));
    if (exact != 0) {
      ASSERT_EQ(moved, exact);
      continue;
    }
    const std::array<Wide, 3> n = product(less(p[1], p[0]), less(p[2], p[0]));
    ASSERT_EQ(moved, n[0] != 0 ? sign(n[0]) : n[1] != 0 ? sign(n[1]) : sign(n[2]));
    ++decided;
  }
  EXPECT_GT(decided, 1000);
  // x, y and z decide in this order.
  const Vec3d o{};
  EXPECT_EQ(moved_orientation(o, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 5.0, 5.0}), 1);
  EXPECT_EQ(moved_orientation(o, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {5.0, 0.0, 5.0}), 1);
  EXPECT_EQ(moved_orientation(o, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {5.0, 5.0, 0.0}), -1);
  EXPECT_EQ(moved_orientation(o, {1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}, {5.0, 5.0, 0.0}), 0);
}

TEST(orientation, of_lines_that_meet_is_that_of_the_moved_one) {
  const Vec3d p{0.0, 0.0, -1.0}, q{0.0, 0.0, 1.0};
  // A move along x, then along y, of the upright line against others through its middle.
  EXPECT_EQ(moved_passing(p, q, {0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}),
            orientation({0.1, 0.0, -1.0}, {0.1, 0.0, 1.0}, {0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}));
  EXPECT_EQ(moved_passing(p, q, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}),
            orientation({0.0, 0.1, -1.0}, {0.0, 0.1, 1.0}, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
  EXPECT_EQ(moved_passing(p, q, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}),
            -moved_passing(p, q, {-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
  EXPECT_EQ(moved_passing(p, q, {0.0, 0.0, 3.0}, {0.0, 0.0, 4.0}), 0);
  EXPECT_NE(moved_passing(p, q, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 0);
}

}  // namespace
}  // namespace fexp::exact_signs
