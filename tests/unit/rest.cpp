// SPDX-License-Identifier: Apache-2.0
#include "solve/rest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "solve/diagnostics.hpp"
#include "support/models.hpp"

namespace fexp::solve {
namespace {

/// A plate in the xy plane whose first edge is moved along x and at an angle, and turned about z.
model::Description moved_plate() {
  auto d = test::description(test::rubber, 0.02);
  model::BodyDescription& body = test::add_body(d, "plate", model::Plate{2.0, 1.0, 8, 4, "one"});
  body.velocity = {1.0, -2.0, 3.0};
  body.angular_velocity = {0.5, -4.0, 6.0};
  test::add_box_set(d, "edge", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  model::Prescribed along{"edge", "x", 5.0, "", {}};
  along.axes = model::LocalAxes{{1.0, 0.0, 1.0}, {0.0, 1.0, 0.0}};
  d.prescribed = {along, {"edge", "y", -7.0, "", {}}, {"edge", "rz", 2.0, "", {}}};
  return d;
}

/// What a body has less what it has been booked: the same before and after.
void expect_balanced(const Diagnostics& before, const Diagnostics& after) {
  EXPECT_LT(after.energies.kinetic, before.energies.kinetic);
  EXPECT_NEAR(after.energies.balance(), before.energies.balance(), 1e-12 * before.energies.kinetic);
  const auto momentum = [](const Diagnostics& d) { return d.momenta.linear - d.momenta.external_impulse; };
  const auto spin = [](const Diagnostics& d) { return d.momenta.angular - d.momenta.external_angular_impulse; };
  EXPECT_LT(norm(momentum(after) - momentum(before)), 1e-12 * before.momenta.linear_scale);
  EXPECT_LT(norm(spin(after) - spin(before)), 1e-12 * before.momenta.angular_scale);
}

TEST(bring_to_rest, takes_all_motion_but_what_is_prescribed_and_books_it) {
  const model::Model model = test::build(moved_plate());
  test::DirectRun run(model);
  run.advance(0.1 * model.first_critical_step, 3);
  const model::State before = run.state;
  bring_to_rest(model, run.state, 0);
  expect_balanced(body_diagnostics(model, before, 0), body_diagnostics(model, run.state, 0));
  const std::vector<Index> edge = test::nodes_of(model, "edge");
  const Vec3d direction{std::sqrt(0.5), 0.0, std::sqrt(0.5)};
  for (Index n = 0; n < model.node_count(); ++n) {
    const model::NodeMotion& motion = run.state.motion[at(n)];
    const bool moved = std::find(edge.begin(), edge.end(), n) != edge.end();
    EXPECT_NEAR(dot(motion.velocity, direction), moved ? 5.0 : 0.0, 1e-12);
    EXPECT_NEAR(motion.velocity.y, moved ? -7.0 : 0.0, 1e-12);
    EXPECT_NEAR(dot(motion.velocity, {direction.x, 0.0, -direction.z}), 0.0, 1e-12);
    EXPECT_NEAR(norm(motion.rotation_rate - Vec3d{0.0, 0.0, moved ? 2.0 : 0.0}), 0.0, 1e-12);
    EXPECT_EQ(norm(motion.position - before.motion[at(n)].position), 0.0);
    EXPECT_EQ(norm(run.state.acceleration[at(n)].linear - before.acceleration[at(n)].linear), 0.0);
  }
  // Once more takes nothing.
  const double work = run.state.ledger[0].damping_work;
  bring_to_rest(model, run.state, 0);
  EXPECT_NEAR(run.state.ledger[0].damping_work, work, 1e-24);
}

/// A rigid plate, one that is free or one whose centre and rotation are driven.
model::Description rigid_plate(bool driven) {
  auto d = test::description(test::rubber, 0.02);
  model::BodyDescription& body = test::add_body(d, "plate", model::Plate{2.0, 1.0, 8, 4, "one"});
  body.rigid = true;
  body.rotate.push_back({{1.0, 2.0, 0.0}, 30.0, {}});
  body.velocity = {1.0, -2.0, 3.0};
  body.angular_velocity = {0.5, -4.0, 6.0};
  d.node_sets.emplace_back().name = "plate";
  d.node_sets.back().bodies = {"plate"};
  if (driven) {
    d.prescribed = {{"plate", "y", -7.0, "", {}}, {"plate", "rz", 2.0, "", {}}};
    test::fix(d, "plate", {"rx"});
  }
  return d;
}

TEST(bring_to_rest, stops_a_rigid_body_but_for_its_conditions) {
  for (const bool driven : {false, true}) {
    SCOPED_TRACE(driven ? "driven" : "free");
    const model::Model model = test::build(rigid_plate(driven));
    test::DirectRun run(model);
    run.advance(0.1 * model.first_critical_step, 3);
    const model::State before = run.state;
    bring_to_rest(model, run.state, 0);
    expect_balanced(body_diagnostics(model, before, 0), body_diagnostics(model, run.state, 0));
    EXPECT_LT(norm(run.state.rigid[0].velocity - Vec3d{0.0, driven ? -7.0 : 0.0, 0.0}), 1e-12);
    const Vec3d rate = rotation_rate(model.rigid_bodies[0], run.state.rigid[0]);
    EXPECT_NEAR(rate.x, 0.0, 1e-12);
    EXPECT_NEAR(rate.z, driven ? 2.0 : 0.0, 1e-12);
  }
}

TEST(bring_to_rest, before_an_epoch_starts_it_from_rest) {
  for (const bool rigid : {false, true}) {
    SCOPED_TRACE(rigid ? "rigid" : "soft");
    const model::Model model = test::build(rigid ? rigid_plate(false) : moved_plate());
    test::DirectRun run(model);
    const double dt = 0.1 * model.first_critical_step;
    run.advance(dt, 5);
    test::DirectRun stopped(model, run.state);
    bring_to_rest(model, stopped.state, 0);
    stopped.advance(dt, 5);
    run.advance(dt, 5, true);
    EXPECT_EQ(model::body_hash(model, run.state, 0), model::body_hash(model, stopped.state, 0));
  }
}

}  // namespace
}  // namespace fexp::solve
