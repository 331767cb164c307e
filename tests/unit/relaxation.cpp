// SPDX-License-Identifier: Apache-2.0
#include "cluster/relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cluster/simulation.hpp"
#include "support/models.hpp"

namespace fexp::cluster {
namespace {

model::RunSettings settings(double residual) {
  model::RunSettings run;
  run.analysis = "static";
  run.residual = residual;
  return run;
}

TEST(relaxation, damps_critically_the_frequency_at_which_the_model_moves) {
  Relaxation relaxation;
  EXPECT_EQ(relaxation.damping(), 0.0);
  relaxation.add({1.0, 1.0, 90.0, 10.0}, settings(0.1), 0.0, 0.0);
  EXPECT_DOUBLE_EQ(relaxation.damping(), 2.0 * 3.0);
  // Softening, and no motion at all, tell nothing.
  relaxation.add({1.0, 1.0, -1.0, 10.0}, settings(0.1), 0.0, 0.0);
  relaxation.add({1.0, 1.0, 0.0, 0.0}, settings(0.1), 0.0, 0.0);
  EXPECT_DOUBLE_EQ(relaxation.damping(), 2.0 * 3.0);
}

TEST(relaxation, has_settled_when_forces_and_velocities_are_small_and_loads_have_come_to_their_end) {
  Relaxation relaxation;
  const model::RunSettings run = settings(0.1);
  relaxation.add({4.0, 100.0, 0.0, 0.0}, run, 1.0, 2.0);
  EXPECT_EQ(relaxation.residual(), 1.0);
  relaxation.add({0.0, 100.0, 0.0, 0.0}, run, 3.0, 2.0);  // Balanced in passing
  EXPECT_EQ(relaxation.residual(), 1.0);
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({4.0, 0.0, 0.0, 0.0}, run, 3.0, 2.0);  // At the end of a swing
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({0.01, 1.0, 0.0, 0.0}, run, 1.5, 2.0);  // The load still grows
  EXPECT_DOUBLE_EQ(relaxation.residual(), 0.1);
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({0.01, 1.0, 0.0, 0.0}, run, 2.0, 2.0);
  EXPECT_TRUE(relaxation.settled());
}

/// A strip that is pulled, and a sphere that nothing holds.
TEST(relaxation, of_a_model_ends_at_its_static_answer_or_not_at_all) {
  for (const bool held : {true, false}) {
    model::Description d = test::description({1000.0, 1.0e6, 0.0}, 0.1);
    d.run.analysis = "static";
    model::Plate strip;
    strip.length_x = 10.0;
    strip.length_y = 1.0;
    strip.cells_x = 20;
    strip.cells_y = 1;
    test::add_body(d, "strip", strip);
    test::add_box_set(d, "left", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
    test::add_box_set(d, "right", {9.99, -1.0, -1.0}, {10.01, 2.0, 1.0});
    if (held) {
      test::fix(d, "left", {"x"});
    }
    d.curves.push_back({"slowly", {{0.0, 0.0}, {2.0, 1.0}}, {}});
    d.forces.push_back({"right", {10.0, 0.0, 0.0}, {}, true, "slowly", {}});
    const model::Model model = test::build(d);
    EXPECT_EQ(end_of_curves(model), 2.0);
    Simulation simulation(model, solve::KernelChoice::automatic);
    while (!simulation.relaxation().settled() && simulation.state().time < 60.0) {
      ASSERT_EQ(simulation.run_epoch(60.0).fault.kind, FaultKind::none);
    }
    EXPECT_EQ(simulation.relaxation().settled(), held);
    if (held) {
      const Index tip = test::nodes_of(model, "right").front();
      const double moved = simulation.state().motion[at(tip)].position.x - 10.0;
      EXPECT_NEAR(moved, 10.0 * 10.0 / (1.0e6 * 0.1), 1e-3 * 1e-3);
      EXPECT_GT(simulation.state().time, 2.0);
    }
  }
}

// The reaction where a displacement is prescribed stays, however long the run waits.
TEST(relaxation, of_a_model_with_prescribed_displacements_ends_in_balance) {
  model::Description d = test::description({1000.0, 1.0e6, 0.0}, 0.1);
  d.run.analysis = "static";
  test::add_body(d, "strip", model::Plate{10.0, 1.0, 20, 1, "one"});
  test::add_box_set(d, "left", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::add_box_set(d, "middle", {4.99, -1.0, -1.0}, {5.01, 2.0, 1.0});
  test::add_box_set(d, "right", {9.99, -1.0, -1.0}, {10.01, 2.0, 1.0});
  test::fix(d, "left", {"x"});
  d.curves.push_back({"slowly", {{0.0, 0.0}, {5.0, 1.0}}, {}});
  model::Prescribed pulled;
  pulled.set = "right";
  pulled.dof = "x";
  pulled.displacement = 1.0e-3;
  pulled.curve = "slowly";
  d.prescribed.push_back(pulled);
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  while (!simulation.relaxation().settled() && simulation.state().time < 60.0) {
    ASSERT_EQ(simulation.run_epoch(60.0).fault.kind, FaultKind::none);
  }
  EXPECT_TRUE(simulation.relaxation().settled());
  const Index middle = test::nodes_of(model, "middle").front();
  EXPECT_NEAR(simulation.state().motion[at(middle)].position.x - 5.0, 0.5e-3, 1e-3 * 0.5e-3);
}

}  // namespace
}  // namespace fexp::cluster
