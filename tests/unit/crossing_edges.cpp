// SPDX-License-Identifier: Apache-2.0
#include "physics/crossing_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace fexp::physics {
namespace {

Vec3d random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> place(-size, size);
  return {place(random), place(random), place(random)};
}

/// Two edges that cross, one `gap` above the other, and roofs of triangles that fall away from the crossing.
CrossingEdges roofs(double gap, double slope, int triangles_below, int triangles_above) {
  CrossingEdges e;
  e.end = {Vec3d{-1.0, 0.0, 0.0}, Vec3d{1.0, 0.0, 0.0}, Vec3d{0.0, -1.0, gap}, Vec3d{0.0, 1.0, gap}};
  e.corner[0] = {Vec3d{0.0, 1.0, -slope}, Vec3d{0.0, -1.0, -slope}};
  e.corner[1] = {Vec3d{1.0, 0.0, gap + slope}, Vec3d{-1.0, 0.0, gap + slope}};
  e.triangles = {triangles_below, triangles_above};
  return e;
}

ClosestOnLines lines_of(const CrossingEdges& e) { return closest_on_lines(e.end[0], e.end[1], e.end[2], e.end[3]); }

double part_of(const CrossingEdges& e, int side) { return sharpness_of(e, lines_of(e), side).part; }

TEST(closest_on_lines, gives_the_points_that_are_closest_and_the_gap_along_the_normal) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a0 = random_point(random, 1.0), a1 = random_point(random, 1.0), b0 = random_point(random, 1.0),
                b1 = random_point(random, 1.0);
    const ClosestOnLines c = closest_on_lines(a0, a1, b0, b1);
    if (c.sine2 < 1e-4) {
      continue;
    }
    const Vec3d offset = b0 + c.second * (b1 - b0) - (a0 + c.first * (a1 - a0));
    EXPECT_NEAR(dot(offset, a1 - a0), 0.0, 1e-9);
    EXPECT_NEAR(dot(offset, b1 - b0), 0.0, 1e-9);
    EXPECT_NEAR(dot(offset, c.normal) / norm(c.normal), c.gap, 1e-9);
  }
}

TEST(closest_on_lines, of_parallel_edges_and_edges_without_length_says_so) {
  EXPECT_EQ(closest_on_lines({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 1, 0}).sine2, 0.0);
  EXPECT_EQ(closest_on_lines({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {2, 1, 0}).sine2, 0.0);
}

TEST(edge_distance, is_the_smallest_over_fine_steps_along_both_edges) {
  std::mt19937 random(4);
  constexpr int steps = 60;
  for (int i = 0; i < 300; ++i) {
    const Vec3d a0 = random_point(random, 1.0), a1 = random_point(random, 1.0), b0 = random_point(random, 1.0),
                b1 = i % 10 == 0 ? b0 + 2.0 * (a1 - a0) : random_point(random, 1.0);
    double least = HUGE_VAL;
    for (int s = 0; s <= steps; ++s) {
      for (int t = 0; t <= steps; ++t) {
        const Vec3d p = a0 + (s / double{steps}) * (a1 - a0), q = b0 + (t / double{steps}) * (b1 - b0);
        least = std::min(least, norm(q - p));
      }
    }
    const double distance = std::sqrt(edge_distance2(a0, a1, b0, b1));
    EXPECT_LE(distance, least * (1.0 + 1e-12));
    EXPECT_GE(distance, least - (norm(a1 - a0) + norm(b1 - b0)) / (2.0 * steps));
  }
}

TEST(edge_distance, of_edges_without_length_is_that_of_points) {
  EXPECT_EQ(edge_distance2({0, 0, 0}, {0, 0, 0}, {3, 4, 0}, {3, 4, 0}), 25.0);
}

bool cross_within_both(const ClosestOnLines& c, double least_sine2) {
  return c.sine2 > least_sine2 && c.first > 0.0 && c.first < 1.0 && c.second > 0.0 && c.second < 1.0;
}

/// Ends that move by half the motion each, in directions that were best among some, and then among some near these.
TEST(motion_before_crossing, is_less_than_any_motion_that_makes_edges_cross) {
  std::mt19937 random(6);
  const auto direction = [&] {
    const Vec3d d = random_point(random, 1.0);
    return (1.0 / norm(d)) * d;
  };
  constexpr double least_sine2 = parallel_sine2;
  int outside = 0, parallel = 0;
  double tightest = HUGE_VAL;
  for (int i = 0; i < 20000; ++i) {
    const std::array<Vec3d, 4> x{random_point(random, 1.0), random_point(random, 1.0), random_point(random, 1.0),
                                 random_point(random, 1.0)};
    std::array<Vec3d, 4> e = x;
    if (i % 3 == 0) {
      // Almost parallel, of other lengths, at all distances
      e[3] = e[2] + (0.2 + 0.001 * (i % 2000)) * (e[1] - e[0]) + 0.04 * random_point(random, norm(e[1] - e[0]));
    }
    const ClosestOnLines c = closest_on_lines(e[0], e[1], e[2], e[3]);
    const double motion = motion_before_crossing(e[0], e[1], e[2], e[3], c, least_sine2);
    if (cross_within_both(c, least_sine2)) {
      ASSERT_EQ(motion, 0.0);
      continue;
    }
    (c.sine2 > least_sine2 ? outside : parallel) += 1;
    for (int k = 0; k < 40; ++k) {
      std::array<Vec3d, 4> moved = e;
      for (Vec3d& end : moved) {
        end += (0.5 * motion) * direction();
      }
      const ClosestOnLines now = closest_on_lines(moved[0], moved[1], moved[2], moved[3]);
      ASSERT_FALSE(cross_within_both(now, least_sine2)) << "edges " << i << " motion " << motion;
    }
    // By moving one edge as a whole the crossing is reached, so that the bound means something.
    if (c.sine2 > 0.5 && motion > 0.0) {
      const Vec3d a = e[1] - e[0], b = e[3] - e[2];
      const double first = std::min(std::max(c.first, 0.001), 0.999),
                   second = std::min(std::max(c.second, 0.001), 0.999);
      tightest = std::min(tightest, norm((c.first - first) * a - (c.second - second) * b) / motion);
    }
  }
  EXPECT_GT(outside, 5000);
  EXPECT_GT(parallel, 500);
  EXPECT_GE(tightest, 1.0);
  EXPECT_LT(tightest, 10.0);
}

TEST(motion_before_crossing, is_nothing_where_edges_cross_or_have_no_length_and_grows_with_how_far_off_they_are) {
  const auto of = [](const Vec3d& shift, double length) {
    const Vec3d b0 = shift + Vec3d{0.0, -0.5, 0.1}, b1 = b0 + Vec3d{0.0, length, 0.0};
    const Vec3d a0{-0.5, 0.0, 0.0}, a1{0.5, 0.0, 0.0};
    return motion_before_crossing(a0, a1, b0, b1, closest_on_lines(a0, a1, b0, b1), parallel_sine2);
  };
  EXPECT_EQ(of({}, 1.0), 0.0);
  EXPECT_EQ(of({0.0, 2.0, 0.0}, 0.0), 0.0);
  const double near = of({0.6, 0.0, 0.0}, 1.0), far = of({0.8, 0.0, 0.0}, 1.0);
  EXPECT_GT(near, 0.01);
  EXPECT_LT(near, 0.1);
  EXPECT_GT(far, near);
  EXPECT_EQ(of({50.0, 0.0, 0.0}, 1.0), 0.1);
}

TEST(sharpness, is_full_where_both_surfaces_fall_away_and_fades_where_one_leads_to_the_other_edge) {
  EXPECT_EQ(part_of(roofs(0.1, 0.5, 2, 2), 1), 1.0);
  // From the other side the roofs are valleys.
  EXPECT_EQ(part_of(roofs(0.1, 0.5, 2, 2), -1), 0.0);
  CrossingEdges one_leads = roofs(0.1, 0.5, 2, 2);
  one_leads.corner[1][1].z = 0.1;  // Across the normal: half of the other one's fall is left
  const double along = part_of(one_leads, 1);
  EXPECT_NEAR(along, (0.5 * std::sqrt(0.2) - flat_sine) / fading_sine, 1e-14);
  one_leads.corner[1][1].z = 0.05;
  EXPECT_GT(part_of(one_leads, 1), 0.5 * along);
  EXPECT_LT(part_of(one_leads, 1), along);
  one_leads.corner[1][1].z = 0.1 - 0.32;
  EXPECT_EQ(part_of(one_leads, 1), 0.0);
}

TEST(sharpness, of_flat_folds_is_none_and_of_flat_free_edges_full) {
  EXPECT_EQ(part_of(roofs(0.1, 0.0, 2, 2), 1), 0.0);
  EXPECT_EQ(part_of(roofs(0.1, 0.0, 1, 1), 1), 1.0);
  EXPECT_EQ(part_of(roofs(0.1, 0.0, 1, 2), 1), 0.0);
  EXPECT_EQ(part_of(roofs(0.1, -0.5, 1, 1), 1), 0.0);
}

TEST(sharpness, fades_as_edges_come_to_be_parallel) {
  CrossingEdges e = roofs(0.1, 0.5, 1, 1);
  const auto turned = [&](double sine) {
    e.end[2] = Vec3d{-1.0, -sine, 0.1};
    e.end[3] = Vec3d{1.0, sine, 0.1};
    e.corner[1][0] = Vec3d{0.0, 1.0, 1.0};
    const ClosestOnLines lines = lines_of(e);
    return sharpness_of(e, lines, lines.gap > 0.0 ? 1 : -1).part;
  };
  EXPECT_EQ(turned(0.2), 1.0);
  EXPECT_EQ(turned(0.04), 0.0);
  const double between = turned(0.075);
  EXPECT_GT(between, 0.1);
  EXPECT_LT(between, 0.9);
}

TEST(sharpness, has_the_gradient_that_it_gives) {
  std::mt19937 random(5);
  constexpr double step = 1e-6;
  int faded = 0, by_angle = 0;
  for (int i = 0; i < 6000; ++i) {
    CrossingEdges e = roofs(0.3, 0.2, 1 + i % 2, 1 + (i / 2) % 2);
    if (i % 5 == 0) {  // A web below the first roof
      e.corner[0][2] = Vec3d{0.1, 0.1, -1.0};
      e.triangles[0] = 3;
    }
    if (i % 3 == 0) {  // Nearly parallel
      e.end[2] = {-1.0, -0.075, 0.3};
      e.end[3] = {1.0, 0.075, 0.3};
    }
    for (Vec3d& x : e.end) {
      x += random_point(random, 0.2);
    }
    for (auto& corners : e.corner) {
      for (Vec3d& x : corners) {
        x += random_point(random, 0.2);
      }
    }
    const Sharpness s = sharpness_of(e, lines_of(e), 1);
    if (!(s.part > 0.02) || !(s.part < 0.98)) {
      continue;
    }
    ++faded;
    by_angle += s.corner[0] < 0 ? 1 : 0;
    const auto slope = [&](Vec3d& x, const Vec3d& direction) {
      const Vec3d kept = x;
      x = kept + step * direction;
      const double ahead = part_of(e, 1);
      x = kept - step * direction;
      const double behind = part_of(e, 1);
      x = kept;
      return (ahead - behind) / (2.0 * step);
    };
    for (const Vec3d& direction : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
      for (std::size_t end = 0; end < 4; ++end) {
        EXPECT_NEAR(slope(e.end[end], direction), dot(s.end[end], direction), 2e-5) << i;
      }
      for (std::size_t c = 0; c < 2 * most_at_edge; ++c) {
        double expected = 0.0;
        for (std::size_t k = 0; k < 2; ++k) {
          expected += static_cast<int>(c) == s.corner[k] ? dot(s.by_corner[k], direction) : 0.0;
        }
        EXPECT_NEAR(slope(e.corner[c / most_at_edge][c % most_at_edge], direction), expected, 2e-5) << i;
      }
    }
  }
  EXPECT_GT(faded, 300);
  EXPECT_GT(by_angle, 30);
}

}  // namespace
}  // namespace fexp::physics
