// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "cluster/swept_boxes.hpp"
#include "model/body_properties.hpp"
#include "solve/diagnostics.hpp"
#include "solve/loads.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using std::numbers::pi;

using test::rubber;
constexpr double thickness = 0.02;

/// A rigid plate of 2 x 1 in the xy plane, centred at (1, 0.5, 0), which the set "plate" has, beside a soft one.
model::Description rigid_plate() {
  auto d = test::description(rubber, thickness);
  test::add_body(d, "plate", model::Plate{2.0, 1.0, 8, 4, "one"}).rigid = true;
  test::add_body(d, "soft", model::Plate{1.0, 1.0, 2, 2, "one"}).translate = {0.0, 0.0, 5.0};
  d.node_sets.emplace_back().name = "plate";
  d.node_sets.back().bodies = {"plate"};
  return d;
}

void run(const model::Model& model, test::DirectRun& direct, double time, int steps) {
  direct.advance(time / steps, static_cast<Index>(steps));
  EXPECT_LT(time / steps, model.first_critical_step);
}

TEST(rigid_bodies, have_the_mass_and_inertia_of_their_slab) {
  auto d = rigid_plate();
  d.bodies[0].rotate.push_back({{0.0, 1.0, 0.0}, 30.0, {}});
  d.point_masses.push_back({"plate", 9.0, 0.9, true, {}});
  const model::Model model = test::build(d);
  ASSERT_EQ(model.rigid_bodies.size(), 1U);
  const model::RigidBody& rigid = model.rigid_bodies[0];
  EXPECT_EQ(model.bodies[0].rigid, 0);
  EXPECT_EQ(model.bodies[1].rigid, no_index);
  EXPECT_NEAR(rigid.mass, 40.0 + 9.0, 1e-12);
  double points = 0.0;  // The point masses' own inertia about z
  for (const Index n : test::nodes_of(model, "plate")) {
    const Vec3d r = model.reference_position[at(n)] - rigid.centre;
    points += 0.2 * dot(r, r);
  }
  EXPECT_NEAR(rigid.inertia[2], 40.0 * 5.0 / 12.0 + points + 0.9, 1e-9);
  EXPECT_NEAR(std::abs(dot(rigid.axis[2], Vec3d{0.5, 0.0, std::sqrt(0.75)})), 1.0, 1e-12);
  EXPECT_GT(rigid.inertia_ratio, 1.0);
  EXPECT_LT(rigid.inertia_ratio, 1.2);
}

TEST(rigid_bodies, of_given_mass_scale_their_density) {
  auto d = rigid_plate();
  d.bodies[0].mass = 100.0;
  d.bodies[0].array = model::Array{{2, 1, 1}, {0.0, 0.0, 0.0}};
  d.bodies[0].array->pitch.x = 3.0;
  const model::Model model = test::build(d);
  for (int copy : {0, 1}) {
    EXPECT_NEAR(model.rigid_bodies[at(copy)].mass, 100.0, 1e-12);
    EXPECT_NEAR(model.rigid_bodies[at(copy)].inertia[2], 100.0 * 5.0 / 12.0, 1e-9);
  }
  EXPECT_NEAR(model::body_properties(model, 0).mass, 100.0, 1e-12);
}

TEST(rigid_bodies, do_not_limit_the_step_by_their_elements) {
  auto d = rigid_plate();
  d.run.minimum_step = 1.0;
  d.bodies[1].mesh = model::MeshGenerator(model::Plate{1.0, 1.0, 1, 1, "one"});
  const model::Model coarse = test::build(d);
  EXPECT_TRUE(coarse.bodies[1].elements.contains(coarse.first_critical_element));
  for (Index e = 0; e < coarse.bodies[0].elements.end; ++e) {
    EXPECT_EQ(coarse.mass_factor(e), 1.0) << "mass scaling leaves rigid bodies alone";
  }
  auto state = model::initial_state(coarse);
  EXPECT_EQ(solve::body_critical_step(coarse, state, 0).step, coarse.first_critical_step);
  state.rigid[0].angular_momentum = {0.0, 0.0, 1.0e6 * coarse.rigid_bodies[0].inertia[2]};
  EXPECT_NEAR(solve::body_critical_step(coarse, state, 0).step, 0.2e-6, 1e-15) << "a fast turn does";
  d.bodies.pop_back();
  d.run.minimum_step = -1.0;
  const model::Model alone = test::build(d);
  EXPECT_GT(alone.first_critical_step, 0.0);
  EXPECT_LT(alone.first_critical_step, 1.0) << "without a body that deforms they stand in";
}

TEST(rigid_bodies, held_altogether_are_barriers) {
  auto d = rigid_plate();
  test::fix(d, "plate", {"x", "y", "z", "rx", "ry", "rz"});
  const model::Model model = test::build(d);
  EXPECT_TRUE(model.bodies[0].barrier);
  EXPECT_EQ(model.fixed.size(), at(model.bodies[0].nodes.size()));
}

TEST(rigid_bodies, move_as_the_conditions_on_all_their_nodes_say) {
  auto d = rigid_plate();
  d.curves.push_back({"push", {{0.0, 0.0}, {0.02, 1.0}}, {}});
  test::fix(d, "plate", {"y", "rx", "ry"});
  model::Prescribed lift{"plate", "z", {}, "push", {}};
  lift.displacement = 0.3;
  model::Prescribed turn{"plate", "rz", {}, "push", {}};
  turn.displacement = 0.5 * pi;
  d.prescribed = {lift, turn};
  d.forces.push_back({"plate", {4.0, 3.0, 5.0}, {0.1, 0.2, 0.3}, true, "", {}});
  const model::Model model = test::build(d);
  EXPECT_TRUE(model.fixed.empty() && model.prescribed.empty() && model.oblique.empty());
  test::DirectRun direct(model);
  const double start = solve::diagnostics(model, direct.state).energies.balance();
  run(model, direct, 0.02, 200);
  const model::RigidMotion& motion = direct.state.rigid[0];
  EXPECT_NEAR(motion.centre.x, 1.0 + 0.5 * 4.0 / 40.0 * 0.02 * 0.02, 1e-12) << "free";
  EXPECT_EQ(motion.centre.y, 0.5) << "held";
  EXPECT_NEAR(motion.centre.z, 0.3, 1e-13) << "moved";
  const Vec3d corner = direct.state.motion[0].position - motion.centre;
  const Vec3d before = model.reference_position[0] - model.rigid_bodies[0].centre;
  EXPECT_NEAR(norm(corner - Vec3d{-before.y, before.x, 0.0}), 0.0, 1e-8) << "a quarter turn";
  const solve::Diagnostics end = solve::diagnostics(model, direct.state);
  EXPECT_NEAR(end.energies.balance(), start, 1e-9 * end.energies.kinetic);
  EXPECT_NEAR(norm(end.momenta.linear - end.momenta.external_impulse), 0.0, 1e-12 * end.momenta.linear_scale);
  EXPECT_NEAR(norm(end.momenta.angular - end.momenta.external_angular_impulse), 0.0, 1e-12 * end.momenta.angular_scale);
}

TEST(rigid_bodies, turn_about_an_axis_at_an_angle_as_a_moment_about_it_says) {
  auto d = rigid_plate();
  const model::LocalAxes axes{{1.0, 0.0, 1.0}, {0.0, 1.0, 0.0}};
  d.fixed.push_back({"plate", {"x", "y", "z", "rx", "ry"}, {}, axes});  // Only about (-1, 0, 1).
  d.forces.push_back({"plate", {}, {0.0, 0.0, 20.0}, true, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun direct(model);
  run(model, direct, 0.1, 400);
  const Vec3d axis = std::sqrt(0.5) * Vec3d{-1.0, 0.0, 1.0};
  const Vec3d rate = direct.state.motion[0].rotation_rate;
  EXPECT_NEAR(norm(rate - dot(rate, axis) * axis), 0.0, 1e-15);
  const double inertia = 0.5 * 40.0 * ((1.0 + 4.0) + (1.0 + thickness * thickness)) / 12.0;
  EXPECT_NEAR(dot(rate, axis), 20.0 * std::sqrt(0.5) / inertia * 0.1, 1e-12);
  const solve::Diagnostics end = solve::diagnostics(model, direct.state);
  EXPECT_NEAR(end.energies.balance(), 0.0, 1e-12 * end.energies.external);
  EXPECT_NEAR(norm(end.momenta.angular - end.momenta.external_angular_impulse), 0.0, 1e-12 * end.momenta.angular_scale);
}

TEST(rigid_bodies, follow_prescribed_velocity_and_acceleration) {
  auto d = rigid_plate();
  d.bodies[0].velocity = {0.0, 2.0, 0.0};
  d.bodies[0].angular_velocity = {0.0, 0.0, 3.0};
  d.prescribed.push_back({"plate", "x", 1.5, "", {}});
  model::Prescribed up{"plate", "y", {}, "", {}};
  up.acceleration = 10.0;
  model::Prescribed spin{"plate", "rz", {}, "", {}};
  spin.acceleration = -100.0;
  d.prescribed.push_back(up);
  d.prescribed.push_back(spin);
  const model::Model model = test::build(d);
  test::DirectRun direct(model);
  run(model, direct, 0.01, 100);
  EXPECT_NEAR(direct.state.rigid[0].velocity.x, 1.5, 1e-14);
  EXPECT_NEAR(direct.state.rigid[0].velocity.y, 2.1, 1e-13);
  EXPECT_NEAR(direct.state.motion[5].rotation_rate.z, 2.0, 1e-12);
  EXPECT_EQ(direct.state.motion[5].rotation_rate, direct.state.motion[0].rotation_rate);
}

TEST(rigid_bodies, stay_inside_the_way_that_they_are_allowed_in_one_step) {
  auto d = rigid_plate();
  d.bodies[0].angular_velocity = {3.0, 0.0, 4.0};
  d.bodies[0].velocity = {0.5, 0.0, 0.0};
  d.prescribed.push_back({"plate", "x", 9.0, "", {}});
  d.prescribed.push_back({"plate", "rz", -7.0, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun direct(model);
  const double dt = 0.5 * model.first_critical_step;
  for (int i = 0; i < 20; ++i) {
    const cluster::BodyExtent extent = cluster::extent_of(model, direct.state, 0);
    const double allowance = cluster::travel_allowance(model, 0, extent, dt, 1) - 0.01 * extent.size;
    const auto before = direct.state.motion;
    direct.advance(dt, 1);
    for (Index n = 0; n < model.bodies[0].nodes.end; ++n) {
      EXPECT_LE(norm(direct.state.motion[at(n)].position - before[at(n)].position), allowance);
    }
  }
}

TEST(rigid_bodies, lose_nothing_to_damping_where_they_are_held_or_told_to_move) {
  // A force at a corner that moves nothing: what damping took of each half step would be energy from nowhere.
  auto d = rigid_plate();
  test::add_box_set(d, "corner", {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01});
  d.forces.push_back({"corner", {300.0, 200.0, 600.0}, {}, false, "", {}});
  d.run.damping = 50.0;
  test::fix(d, "plate", {"y", "z", "rx", "ry", "rz"});
  for (const double velocity : {0.0, 0.5}) {
    d.prescribed.clear();
    d.prescribed.push_back({"plate", "x", velocity, "", {}});
    d.bodies[0].velocity = {velocity, 0.0, 0.0};
    const model::Model model = test::build(d);
    test::DirectRun direct(model);
    const double before = solve::diagnostics(model, direct.state).energies.balance();
    run(model, direct, 0.05, 40);
    const solve::Energies energies = solve::diagnostics(model, direct.state).energies;
    EXPECT_NEAR(energies.balance(), before, 1e-12 * (1.0 + energies.kinetic)) << velocity;
    EXPECT_NEAR(energies.kinetic, 20.0 * velocity * velocity, 1e-12);
  }
}

TEST(rigid_bodies, have_loads_on_single_nodes_act_on_the_whole_body) {
  auto d = rigid_plate();
  test::add_box_set(d, "corner", {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01});
  d.forces.push_back({"corner", {0.0, 0.0, 6.0}, {}, false, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun direct(model);
  const model::RigidMotion& motion = direct.state.rigid[0];
  EXPECT_EQ(motion.force, (Vec3d{0.0, 0.0, 6.0}));
  EXPECT_NEAR(norm(motion.moment - Vec3d{-3.0, 6.0, 0.0}), 0.0, 1e-14);
  // M^-1 of the whole body: a node alone would get a = f/m, and the balance an allowance without meaning.
  const double slab = 40.0 / 12.0, t2 = thickness * thickness;
  EXPECT_NEAR(solve::sudden_load_energy(model, direct.state, 0.1),
              0.125 * 0.01 * (36.0 / 40.0 + 9.0 / (slab * (1.0 + t2)) + 36.0 / (slab * (4.0 + t2))), 1e-9);
}

}  // namespace
}  // namespace fexp
