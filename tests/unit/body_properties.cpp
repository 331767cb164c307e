// SPDX-License-Identifier: Apache-2.0
#include "model/body_properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

constexpr double density = 2000.0;
constexpr double slab_thickness = 0.02;
const physics::LinearElastic law{density, 1.0e9, 0.3};

TEST(body_properties, a_plate_far_away_has_those_of_a_thick_slab) {
  Description d = test::description(law, slab_thickness);
  test::add_body(d, "plate", Plate{3.0, 2.0, 5, 3, "one"}).translate = {1000.0, -500.0, 20.0};
  const BodyProperties p = body_properties(test::build(d), 0);
  const double mass = density * slab_thickness * 6.0;
  EXPECT_NEAR(p.mass, mass, 1e-9 * mass);
  EXPECT_NEAR(norm(p.centre - Vec3d{1001.5, -499.0, 20.0}), 0.0, 1e-9);
  const double t2 = slab_thickness * slab_thickness;
  EXPECT_NEAR(p.inertia[0], mass * (4.0 + t2) / 12.0, 1e-9 * mass);
  EXPECT_NEAR(p.inertia[1], mass * (9.0 + t2) / 12.0, 1e-9 * mass);
  EXPECT_NEAR(p.inertia[2], mass * 13.0 / 12.0, 1e-9 * mass);
  EXPECT_NEAR(p.inertia[3], 0.0, 1e-9 * mass);
  EXPECT_EQ(p.box.low, (Vec3d{1000.0, -500.0, 20.0}));
  EXPECT_EQ(p.box.high, (Vec3d{1003.0, -498.0, 20.0}));
}

TEST(body_properties, products_of_inertia_have_the_sign_of_the_tensor) {
  Description d = test::description(law, slab_thickness);
  // A strip along the direction (1, 1, 0): the mass lies where x and y have the same sign.
  BodyDescription& strip = test::add_body(d, "strip", Plate{2.0, 0.1, 8, 1, "one"});
  strip.rotate.push_back({{0.0, 0.0, 1.0}, 45.0, {}});
  const BodyProperties p = body_properties(test::build(d), 0);
  EXPECT_NEAR(p.inertia[3], -p.mass * (4.0 - 0.01) / 24.0, 1e-9 * p.mass);
}

TEST(body_properties, a_fine_sphere_tends_to_a_thin_shell_with_second_order) {
  const auto error_of = [](int cells) {
    Description d = test::description(law, 1.0e-3);
    test::add_body(d, "ball", CubedSphere{0.5, cells});
    const BodyProperties p = body_properties(test::build(d), 0);
    const double exact = 2.0 / 3.0 * (4.0 * std::numbers::pi * 0.25 * density * 1.0e-3) * 0.25;
    return std::abs(p.inertia[0] / exact - 1.0);
  };
  const double coarse = error_of(8), fine = error_of(16);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

TEST(body_properties, two_bodies_together_add_up_by_the_parallel_axis_theorem) {
  Description d = test::description(law, slab_thickness);
  test::add_body(d, "left", CubedSphere{0.5, 4}).translate = {-3.0, 0.0, 0.0};
  test::add_body(d, "right", CubedSphere{0.5, 4}).translate = {3.0, 0.0, 0.0};
  const Model model = test::build(d);
  const BodyProperties one = body_properties(model, 1), all = total_properties(model);
  EXPECT_NEAR(all.mass, 2.0 * one.mass, 1e-12 * all.mass);
  EXPECT_NEAR(all.inertia[0], 2.0 * one.inertia[0], 1e-9 * all.inertia[0]);
  EXPECT_NEAR(all.inertia[1], 2.0 * (one.inertia[1] + one.mass * 9.0), 1e-9 * all.inertia[1]);
}

}  // namespace
}  // namespace fexp::model
