// SPDX-License-Identifier: Apache-2.0
#include "physics/drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fexp::physics {
namespace {

constexpr Vec3d up{0.0, 0.0, 1.0};

DragPair pair_with(const Vec3d& way) { return {up, 10.0, 1000.0, 2.0, way, 1e-3}; }

TEST(friction, sticks_below_coulombs_limit_and_gives_back_what_it_has_stored) {
  const DragLaw law{0.5, 0.0};
  Vec3d force;
  double stored = 0.0;
  for (const double way : {1e-3, 2e-3, 0.5e-3, -2e-3, -1.5e-3}) {
    const Drag drag = drag_of(law, pair_with({way, 0.5 * way, 0.0}), force);
    EXPECT_NEAR(drag.dissipated, 0.0, 1e-17);
    EXPECT_NEAR(dot(drag.force - force, Vec3d{1.0, 0.0, 0.0}), -1000.0 * way, 1e-12);
    force = drag.force;
    stored = drag.stored;
  }
  EXPECT_NEAR(norm(force), 0.0, 1e-12);
  EXPECT_NEAR(stored, 0.0, 1e-15);
}

TEST(friction, slips_at_coulombs_limit_against_the_way_and_takes_force_times_slip) {
  const DragLaw law{0.3, 0.0};
  Vec3d force = drag_of(law, pair_with({0.1, 0.0, 0.0}), {}).force;
  const Drag drag = drag_of(law, pair_with({0.1, 0.0, 0.0}), force);
  EXPECT_NEAR(drag.force.x, -3.0, 1e-12);
  EXPECT_NEAR(drag.dissipated, 3.0 * 0.1, 1e-12);
}

TEST(friction, turns_with_the_surface) {
  const DragLaw law{0.3, 0.0};
  const Drag drag = drag_of(law, pair_with({}), {2.0, 0.0, 1.0});
  EXPECT_EQ(drag.force, (Vec3d{2.0, 0.0, 0.0}));
}

TEST(damping, opposes_the_normal_velocity_by_its_part_of_the_critical_one_and_does_not_pull) {
  const DragLaw law{0.0, 0.1};
  const double critical = 2.0 * std::sqrt(1000.0 / 2.0);
  EXPECT_NEAR(drag_of(law, pair_with({0.5, 0.0, -1e-3}), {}).force.z, 0.1 * critical, 1e-12);
  EXPECT_NEAR(drag_of(law, pair_with({0.5, 0.0, 1e-3}), {}).force.z, -0.1 * critical, 1e-12);
  EXPECT_EQ(drag_of(law, pair_with({0.0, 0.0, 1.0}), {}).force.z, -10.0);
}

TEST(damping, shortens_the_step_that_a_pair_allows) {
  EXPECT_EQ((DragLaw{0.3, 0.0}.frequency2_factor()), 1.0);
  // Critical step 2 / omega (sqrt(1 + d^2) - d)
  EXPECT_NEAR((DragLaw{0.0, 0.75}.frequency2_factor()), 4.0, 1e-12);
}

TEST(friction, never_makes_energy_while_the_normal_force_stays) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> way(-9e-3, 9e-3);
  const DragLaw law{0.4, 0.0};
  Vec3d force;
  for (int i = 0; i < 20000; ++i) {
    const Drag drag = drag_of(law, pair_with({way(random), way(random), way(random)}), force);
    EXPECT_GE(drag.dissipated, -1e-15);
    EXPECT_LE(norm(drag.force), 0.4 * 10.0 * (1.0 + 1e-12));
    force = drag.force;
  }
}

}  // namespace
}  // namespace fexp::physics
