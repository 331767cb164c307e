// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "cluster/simulation.hpp"
#include "support/models.hpp"

namespace fexp::cluster {
namespace {

using test::rubber;
constexpr double far = 1.0e9;  // a target that no epoch reaches

model::Plate plate(double side, int cells) {
  model::Plate p;
  p.length_x = p.length_y = side;
  p.cells_x = p.cells_y = cells;
  return p;
}

/// Two plates; on the second one acts, from rest, a load that soon throws it out of its swept box. It has an oblique
/// plane of symmetry, a prescribed node, damping and loads with curves, so that all of them are met by a roll-back.
model::Description runaway(bool contact) {
  auto d = test::description(rubber, 0.02);
  d.contact.enabled = contact;
  d.contact.self = false;
  d.run.energy_drift_limit = 10.0;
  d.run.damping = 3.0;
  test::add_body(d, "calm", plate(1.0, 4)).velocity = {0.1, 0.2, 0.3};
  model::BodyDescription& wild = test::add_body(d, "wild", plate(1.0, 4));
  wild.rotate.push_back({{1.0, 2.0, 3.0}, 33.0, {}});
  wild.translate = {2.0, 0.0, 0.5};
  d.curves.push_back({"push", {{0.0, 0.1}, {1.0, 1000.0}}, {}});
  d.gravity.push_back({{-3000.0, 500.0, 800.0}, "push", {}});
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  d.pressure.push_back({{"wild"}, "", 400.0, "push", {}});
  d.planes.push_back({{"wall"}, {-0.1, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  test::add_box_set(d, "side", {1.9, -1.0, -1.0}, {2.4, 2.0, 2.0});
  test::add_box_set(d, "held", {0.9, 0.9, -0.1}, {1.1, 1.1, 0.1});
  d.symmetry.push_back({"side", {0.3, -0.5, 0.7}, {}});
  d.prescribed.push_back({"held", "z", 0.2, "push", {}});
  return d;
}

TEST(epochs, one_that_is_rolled_back_ends_in_the_state_of_one_planned_shorter_from_the_start) {
  for (const bool contact : {false, true}) {
    model::Model model = test::build(runaway(contact));
    Simulation rolled_back(model, solve::KernelChoice::automatic);
    const EpochReport first = rolled_back.run_epoch(far);
    ASSERT_EQ(first.fault.kind, FaultKind::none) << first.fault.message;
    ASSERT_GT(first.rollbacks, 0);
    ASSERT_LT(first.steps, model.run.epoch_steps);

    model::Model other = model;
    other.run.epoch_steps = first.steps;
    Simulation planned(other, solve::KernelChoice::automatic);
    const EpochReport second = planned.run_epoch(far);
    EXPECT_EQ(second.rollbacks, 0);
    EXPECT_EQ(second.steps, first.steps);
    EXPECT_EQ(second.dt, first.dt);
    EXPECT_EQ(model::state_hash(model, rolled_back.state()), model::state_hash(other, planned.state()));

    // What a simulation knows besides its state must be the same as well: both go on alike.
    other.run.epoch_steps = model.run.epoch_steps;
    for (int i = 0; i < 3; ++i) {
      const Index rollbacks = rolled_back.run_epoch(far).rollbacks;
      EXPECT_EQ(planned.run_epoch(far).rollbacks, rollbacks);
      ASSERT_EQ(model::state_hash(model, rolled_back.state()), model::state_hash(other, planned.state()));
    }
  }
}

TEST(epochs, time_ends_exactly_at_the_target_and_steps_add_up) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "p", plate(1.0, 4)).velocity = {1.0, 0.0, 0.0};
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const double target = 1.0;
  std::int64_t steps = 0;
  while (simulation.state().time < target) {
    const double before = simulation.state().time;
    const EpochReport report = simulation.run_epoch(target);
    steps += report.steps;
    EXPECT_LE(report.steps, model.run.epoch_steps);
    EXPECT_NEAR(simulation.state().time - before, report.dt * report.steps, 1e-12 * target);
    EXPECT_LE(report.dt, model.run.safety * model.first_critical_step * (1.0 + 1e-6));
  }
  EXPECT_EQ(simulation.state().time, target);
  EXPECT_EQ(simulation.state().step, steps);
  EXPECT_GT(steps, model.run.epoch_steps);
}

/// A strip, all of whose nodes are driven, that shortens by `speed`.
model::Model crushed_strip(double speed) {
  auto d = test::description(rubber, 0.02);
  d.run.energy_drift_limit = 1.0e3;
  model::Plate mesh = plate(1.0, 1);
  test::add_body(d, "strip", mesh);
  test::add_box_set(d, "left", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  test::add_box_set(d, "right", {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0});
  d.prescribed.push_back({"left", "x", 0.5 * speed, "", {}});
  d.prescribed.push_back({"right", "x", -0.5 * speed, "", {}});
  return test::build(d);
}

TEST(epochs, a_critical_step_that_falls_during_one_has_it_redone_with_a_smaller_step) {
  // The strip loses three tenths of its length in one epoch, more than the margin of the step allows.
  model::Model model = crushed_strip(1.0);
  const double whole_epoch = model.run.safety * model.first_critical_step * model.run.epoch_steps;
  model = crushed_strip(0.3 / whole_epoch);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = simulation.run_epoch(far);
  ASSERT_EQ(report.fault.kind, FaultKind::none) << report.fault.message;
  EXPECT_GT(report.rollbacks, 0);
  EXPECT_LT(report.dt, 0.97 * model.run.safety * model.first_critical_step);
  EXPECT_LT(report.critical.step, 0.95 * model.first_critical_step);
  EXPECT_LE(report.dt, (1.0 - 0.1 * (1.0 - model.run.safety)) * report.critical.step);
}

TEST(faults, a_collapse_names_element_body_and_cure) {
  model::Model model = crushed_strip(1.0);
  model.run.step_collapse = 0.3;
  Simulation simulation(model, solve::KernelChoice::automatic);
  EpochReport report;
  for (int i = 0; i < 100 && report.fault.kind == FaultKind::none; ++i) {
    report = simulation.run_epoch(0.95);
  }
  ASSERT_EQ(report.fault.kind, FaultKind::step_collapsed);
  EXPECT_LE(report.critical.step, 0.3 * model.first_critical_step);
  EXPECT_EQ(report.fault.element, report.critical.element);
  EXPECT_EQ(report.fault.body, 0);
  const std::string label = "element " + std::to_string(model.element_label[at(report.fault.element)]);
  EXPECT_NE(report.fault.message.find(label + " of body \"strip\""), std::string::npos) << report.fault.message;
  EXPECT_NE(report.fault.cure.find("refine"), std::string::npos) << report.fault.cure;
}

/// Two plates, the second with a force at two of its nodes that becomes infinite after a while.
model::Model exploding() {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "sound", plate(1.0, 2)).velocity = {0.0, 0.0, 1.0};
  test::add_body(d, "doomed", plate(1.0, 2)).translate = {3.0, 0.0, 0.0};
  test::add_box_set(d, "corners", {3.4, -0.1, -1.0}, {3.6, 1.1, 1.0});
  const double dt = 0.002;
  d.curves.push_back({"bang", {{100.0 * dt, 0.0}, {100.0 * dt + 1.0e-9, 1.0}}, {}});
  d.forces.push_back({"corners", {0.0, 1.0e308, 0.0}, {}, false, "bang", {}});
  return test::build(d);
}

bool is_finite(const model::State& state) {
  double sum = 0.0;
  for (const model::NodeMotion& m : state.motion) {
    sum += norm(m.position) + norm(m.velocity) + norm(m.rotation_rate);
  }
  for (const model::NodeAcceleration& a : state.acceleration) {
    sum += norm(a.linear) + norm(a.angular);
  }
  for (const double value : state.history) {
    sum += std::abs(value);
  }
  return std::isfinite(sum);
}

TEST(faults, a_number_that_is_not_finite_names_node_body_and_cure_and_leaves_the_last_sound_state) {
  const model::Model model = exploding();
  Simulation simulation(model, solve::KernelChoice::automatic);
  EpochReport report;
  for (int i = 0; i < 100 && report.fault.kind == FaultKind::none; ++i) {
    report = simulation.run_epoch(far);
  }
  ASSERT_EQ(report.fault.kind, FaultKind::not_finite);
  // Of the three loaded nodes the lowest.
  const Index expected = model.node_sets.back().nodes.front();
  EXPECT_EQ(model.node_sets.back().name, "corners");
  EXPECT_EQ(report.fault.node, expected);
  EXPECT_EQ(report.fault.body, 1);
  const auto& corners = model.triangle[at(report.fault.element)];
  EXPECT_NE(std::find(corners.begin(), corners.end(), expected), corners.end());
  const std::string where = "step " + std::to_string(simulation.state().step + 1) + ": the velocity of node " +
                            std::to_string(model.node_label[at(expected)]) + " of body \"doomed\"";
  EXPECT_NE(report.fault.message.find(where), std::string::npos) << report.fault.message;
  EXPECT_FALSE(report.fault.cure.empty());
  EXPECT_TRUE(is_finite(simulation.state()));
  EXPECT_LT(simulation.state().time, 0.2 + 1.0e-9);
  EXPECT_GT(simulation.state().time, 0.2 - model.first_critical_step);
}

TEST(faults, a_force_that_is_infinite_from_the_start_is_met_in_the_first_step) {
  model::Model model = exploding();
  model.curves[0].points = {{0.0, 1.0}};
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = simulation.run_epoch(far);
  EXPECT_EQ(report.fault.kind, FaultKind::not_finite);
  EXPECT_EQ(report.fault.body, 1);
  EXPECT_EQ(report.steps, 0);
  EXPECT_EQ(simulation.state().step, 0);
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    EXPECT_EQ(simulation.state().motion[n].position, model.reference_position[n]);
  }
}

TEST(faults, an_energy_drift_names_the_most_strained_element_its_body_and_the_bound) {
  auto d = test::description(rubber, 0.02);
  d.run.safety = 1.0;
  d.run.energy_drift_limit = 1.0e-9;
  test::add_body(d, "resting", plate(1.0, 3));
  test::add_body(d, "ringing", plate(1.0, 3)).translate = {3.0, 0.0, 0.0};
  d.bodies.back().velocity = {0.0, 0.0, 1.0};
  test::add_box_set(d, "corner", {3.9, 0.9, -1.0}, {4.1, 1.1, 1.0});
  test::fix(d, "corner", {"x", "y", "z"});
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  EpochReport report;
  for (int i = 0; i < 100 && report.fault.kind == FaultKind::none; ++i) {
    report = simulation.run_epoch(far);
  }
  ASSERT_EQ(report.fault.kind, FaultKind::energy_drift);
  EXPECT_GT(report.energy_error, 1.0e-9);
  EXPECT_EQ(report.fault.body, 1);
  EXPECT_EQ(report.fault.other, no_index);
  EXPECT_GT(report.fault.share, 0.99);
  const std::string label = "element " + std::to_string(model.element_label[at(report.fault.element)]);
  EXPECT_NE(report.fault.message.find(label + " of body \"ringing\""), std::string::npos) << report.fault.message;
  EXPECT_NE(report.fault.message.find("1e-09"), std::string::npos) << report.fault.message;
  EXPECT_NE(report.fault.cure.find("energy_drift_limit"), std::string::npos) << report.fault.cure;
}

}  // namespace
}  // namespace fexp::cluster
