// SPDX-License-Identifier: Apache-2.0
#include "physics/penalty.hpp"

#include <gtest/gtest.h>

namespace fexp::physics {
namespace {

constexpr double spring = 3.0, full_depth = 0.2;

TEST(penalty, is_linear_without_hardening_and_without_thickness) {
  for (const Penalty& p : {penalty_of(spring, 0.0, 0.3, full_depth), penalty_of(spring, 2.0, 0.3, 0.0)}) {
    EXPECT_DOUBLE_EQ(p.energy, 0.5 * spring * 0.09);
    EXPECT_DOUBLE_EQ(p.force, spring * 0.3);
    EXPECT_DOUBLE_EQ(p.stiffness, spring);
  }
}

TEST(penalty, has_by_the_hardening_more_energy_where_mid_surfaces_meet) {
  EXPECT_DOUBLE_EQ(penalty_of(spring, 2.0, full_depth, full_depth).energy,
                   3.0 * 0.5 * spring * full_depth * full_depth);
  EXPECT_NEAR(penalty_of(spring, 2.0, 1e-4 * full_depth, full_depth).stiffness, spring, 1e-6 * spring);
}

TEST(penalty, has_the_slopes_that_it_gives_within_the_thickness_and_behind) {
  constexpr double step = 1e-7;
  for (const double depth : {0.02, 0.1, 0.19, 0.21, 0.5}) {
    const Penalty p = penalty_of(spring, 2.0, depth, full_depth),
                  ahead = penalty_of(spring, 2.0, depth + step, full_depth),
                  behind = penalty_of(spring, 2.0, depth - step, full_depth);
    EXPECT_NEAR((ahead.energy - behind.energy) / (2.0 * step), p.force, 1e-7) << depth;
    EXPECT_NEAR((ahead.force - behind.force) / (2.0 * step), p.stiffness, 1e-6) << depth;
  }
}

TEST(penalty, goes_on_without_a_jump_behind_the_full_distance) {
  const Penalty at = penalty_of(spring, 2.0, full_depth, full_depth),
                behind = penalty_of(spring, 2.0, full_depth * (1.0 + 1e-12), full_depth);
  EXPECT_NEAR(behind.energy, at.energy, 1e-10);
  EXPECT_NEAR(behind.force, at.force, 1e-10);
  EXPECT_NEAR(behind.stiffness, at.stiffness, 1e-10);
  EXPECT_DOUBLE_EQ(penalty_of(spring, 2.0, 3.0 * full_depth, full_depth).stiffness, at.stiffness);
}

}  // namespace
}  // namespace fexp::physics
