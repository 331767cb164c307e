// SPDX-License-Identifier: Apache-2.0
#include "contact/kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "parallel/parallel.hpp"

namespace fexp::contact {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  Vec3d point() { return {number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)}; }

 private:
  std::mt19937 random_;
};

std::vector<Index> slow_query(const std::vector<Vec3d>& points, const Box& box) {
  std::vector<Index> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d& p = points[i];
    if (p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y && p.z >= box.low.z &&
        p.z <= box.high.z) {
      found.push_back(static_cast<Index>(i));
    }
  }
  return found;
}

/// Boxes of all kinds: random, of no extent on a point, bounded by points, everything, nothing, inside out.
std::vector<Box> boxes_for(const std::vector<Vec3d>& points, Dice& dice) {
  std::vector<Box> boxes{{{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}},
                         {{5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}},
                         {{0.5, 0.5, 0.5}, {-0.5, -0.5, -0.5}},
                         Box{}};
  for (int i = 0; i < 40; ++i) {
    Box box;
    box.include(dice.point());
    box.include(dice.point());
    boxes.push_back(box);
    if (!points.empty()) {
      const auto pick = [&] {
        return points[static_cast<std::size_t>(dice.number(0.0, 0.999) * double(points.size()))];
      };
      Box on_points;
      on_points.include(pick());
      boxes.push_back(on_points);
      on_points.include(pick());
      boxes.push_back(on_points);
    }
  }
  return boxes;
}

void check(const std::vector<Vec3d>& points, unsigned seed) {
  Dice dice(seed);
  KdTree tree;
  // A build must not depend on the ones before it.
  tree.build(std::vector<Vec3d>(100, Vec3d{0.1, 0.2, 0.3}));
  tree.build(points);
  for (const Box& box : boxes_for(points, dice)) {
    std::vector<Index> found;
    tree.query(box, [&](Index i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, slow_query(points, box)) << points.size() << " points";
  }
}

TEST(kd_tree, finds_what_a_loop_over_all_points_finds) {
  Dice dice(1);
  for (const int count : {0, 1, 2, 7, 8, 9, 15, 16, 17, 18, 31, 32, 33, 100, 1000, 5000}) {
    std::vector<Vec3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(dice.point());
    }
    check(points, 10U + static_cast<unsigned>(count));
  }
}

TEST(kd_tree, finds_all_of_many_points_in_one_place_on_a_line_and_on_a_grid) {
  Dice dice(2);
  std::vector<Vec3d> same(200, Vec3d{0.25, -0.5, 0.125}), line, grid, twice;
  for (int i = 0; i < 500; ++i) {
    const double s = dice.number(-1.0, 1.0);
    line.push_back({s, 0.0, 2.0 * s});
    grid.push_back({0.125 * (i & 7), 0.125 * (i >> 3 & 7), 0.125 * (i >> 6)});
    twice.push_back(i % 2 == 0 ? dice.point() : twice.back());
  }
  check(same, 20);
  check(line, 21);
  check(grid, 22);
  check(twice, 23);
}

TEST(kd_tree, finds_points_that_single_precision_cannot_tell_apart) {
  Dice dice(5);
  std::vector<Vec3d> points;
  for (int i = 0; i < 1000; ++i) {
    points.push_back(1e-12 * dice.point());
  }
  points.push_back({1.0, -1.0, 1e80});
  points.push_back({-1e-300, 0.0, -1e80});
  check(points, 40);
  for (Vec3d& p : points) {
    p = {1e6 + 1e-9 * p.x, 0.0, 0.0};
  }
  check(points, 41);
}

TEST(kd_tree, finds_the_points_whose_own_reach_meets_the_box) {
  Dice dice(4);
  std::vector<Vec3d> points;
  std::vector<double> reach;
  for (int i = 0; i < 2000; ++i) {
    points.push_back(dice.point());
    reach.push_back(i % 100 == 0 ? 0.3 : dice.number(0.0, 0.02));
  }
  KdTree tree;
  tree.build(points, reach);
  for (const Box& box : boxes_for(points, dice)) {
    std::vector<Index> found, expected;
    tree.query(box, [&](Index i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (box.grown(reach[i]).contains(points[i])) {
        expected.push_back(static_cast<Index>(i));
      }
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(kd_tree, built_by_many_threads_finds_the_same) {
  Dice dice(3);
  std::vector<Vec3d> points;
  for (int i = 0; i < 50000; ++i) {
    points.push_back(dice.point());
  }
  for (const int threads : {1, 4}) {
    parallel::with_threads(threads, [&] { check(points, 30); });
  }
}

}  // namespace
}  // namespace fexp::contact
