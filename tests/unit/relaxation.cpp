// SPDX-License-Identifier: Apache-2.0
#include "cluster/relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "support/models.hpp"

namespace fexp::cluster {
namespace {

const std::vector<std::string> methods{"automatic", "viscous", "kinetic"};

model::RunSettings settings(double residual, const std::string& relaxation = "viscous") {
  model::RunSettings run;
  run.analysis = "static";
  run.relaxation = relaxation;
  run.residual = residual;
  return run;
}

TEST(relaxation, damps_critically_the_frequency_at_which_the_model_moves) {
  Relaxation relaxation;
  EXPECT_EQ(relaxation.damping(), 0.0);
  relaxation.add({1.0, 1.0, 90.0, 10.0}, settings(0.1), {0.0, 0.01, 0.0});
  EXPECT_DOUBLE_EQ(relaxation.damping(), 2.0 * 3.0);
  // Softening, and no motion at all, tell nothing.
  relaxation.add({1.0, 1.0, -1.0, 10.0}, settings(0.1), {0.0, 0.01, 0.0});
  relaxation.add({1.0, 1.0, 0.0, 0.0}, settings(0.1), {0.0, 0.01, 0.0});
  EXPECT_DOUBLE_EQ(relaxation.damping(), 2.0 * 3.0);
}

TEST(relaxation, that_is_viscous_never_stops_motion_nor_shortens_epochs) {
  Relaxation relaxation;
  relaxation.add({1.0, 1.0, 90.0, 10.0, -1.0}, settings(0.1), {1.0, 0.01, 0.0});
  EXPECT_FALSE(relaxation.stops());
  EXPECT_EQ(relaxation.longest_epoch(), HUGE_VAL);
}

TEST(relaxation, that_is_kinetic_stops_all_near_the_peak_of_the_kinetic_energy) {
  Relaxation relaxation;
  const model::RunSettings run = settings(0.1, "kinetic");
  EXPECT_EQ(relaxation.longest_epoch(), HUGE_VAL);
  relaxation.add({1.0, 1.0, 0.0, 0.0, 1.0}, run, {1.0, 0.01, 0.0});
  EXPECT_EQ(relaxation.longest_epoch(), HUGE_VAL);  // Nothing is known of the frequency yet
  EXPECT_FALSE(relaxation.stops());
  relaxation.add({1.0, 1.0, 90.0, 10.0, -1e-3}, run, {2.0, 0.01, 0.0});
  EXPECT_TRUE(relaxation.stops());
  EXPECT_EQ(relaxation.damping(), 0.0);
  EXPECT_LT(relaxation.longest_epoch(), 0.1 * 2.0 * 3.14 / 3.0);  // A small part of the period 2 pi/3
  relaxation.add({1.0, 1.0, 90.0, 10.0, 1e-3}, run, {3.0, 0.01, 0.0});
  EXPECT_FALSE(relaxation.stops());
  // A step of 0.3 rad, within which the power falls by 0.1 x 9: the peak is nearer to its start or to its end.
  relaxation.add({1.0, 1.0, 90.0, 10.0, 0.44}, run, {3.0, 0.1, 0.0});
  EXPECT_TRUE(relaxation.stops());
  relaxation.add({1.0, 1.0, 90.0, 10.0, 0.46}, run, {3.0, 0.1, 0.0});
  EXPECT_FALSE(relaxation.stops());
  relaxation.add({1.0, 0.0, 90.0, 10.0, 0.0}, run, {4.0, 0.01, 0.0});  // At rest already
  EXPECT_FALSE(relaxation.stops());
}

/// Which of the methods an automatic choice has at hand.
std::string method_of(const Relaxation& relaxation) {
  const bool damps = relaxation.damping() > 0.0;
  return relaxation.longest_epoch() == HUGE_VAL ? "viscous" : damps ? "both" : "kinetic";
}

/// Epochs of 10 rad without progress until the method changes, 1000 at most.
int epochs_until_change(Relaxation& relaxation, const model::RunSettings& run, double& time) {
  const std::string before = method_of(relaxation);
  int epochs = 0;
  while (method_of(relaxation) == before && epochs < 1000) {
    time += 10.0;
    ++epochs;
    relaxation.add({1.0, 1.0, 10.0, 10.0, 5.0}, run, {time, 0.01, 0.0});
  }
  return epochs;
}

TEST(relaxation, that_chooses_tries_all_methods_in_turn_where_none_helps) {
  Relaxation relaxation;
  const model::RunSettings run = settings(0.1, "automatic");
  double time = 0.0;
  relaxation.add({1.0, 1.0, 10.0, 10.0, -1.0}, run, {time, 0.01, 0.0});
  EXPECT_TRUE(relaxation.stops());
  EXPECT_LT(relaxation.damping(), 1.0);  // The critical one is 2
  EXPECT_EQ(method_of(relaxation), "both");
  int patience = 0;
  for (const std::string next : {"kinetic", "viscous", "both", "kinetic"}) {
    const int epochs = epochs_until_change(relaxation, run, time);
    EXPECT_EQ(method_of(relaxation), next);
    EXPECT_GT(epochs, patience);
    patience = epochs;
  }
}

TEST(relaxation, that_chooses_keeps_the_method_as_long_as_it_helps_or_loads_change) {
  for (const bool loads_change : {true, false}) {
    Relaxation relaxation;
    const model::RunSettings run = settings(1e-12, "automatic");
    double square = 1.0;
    for (int i = 0; i < 1000; ++i) {
      // 10 rad an epoch, and a residual that stands or is halved every third epoch.
      square = !loads_change && i % 3 == 0 ? 0.2 * square : square;
      relaxation.add({square, square, 10.0, 10.0, 5.0}, run, {10.0 * i, 0.01, loads_change ? 1.0e5 : 0.0});
      ASSERT_EQ(method_of(relaxation), "both") << i;
    }
  }
}

TEST(relaxation, has_settled_when_forces_and_velocities_are_small_and_loads_have_come_to_their_end) {
  Relaxation relaxation;
  const model::RunSettings run = settings(0.1);
  relaxation.add({4.0, 100.0, 0.0, 0.0}, run, {1.0, 0.01, 2.0});
  EXPECT_EQ(relaxation.residual(), 1.0);
  relaxation.add({0.0, 100.0, 0.0, 0.0}, run, {3.0, 0.01, 2.0});  // Balanced in passing
  EXPECT_EQ(relaxation.residual(), 1.0);
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({4.0, 0.0, 0.0, 0.0}, run, {3.0, 0.01, 2.0});  // At the end of a swing
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({0.01, 1.0, 0.0, 0.0}, run, {1.5, 0.01, 2.0});  // The load still grows
  EXPECT_DOUBLE_EQ(relaxation.residual(), 0.1);
  EXPECT_FALSE(relaxation.settled());
  relaxation.add({0.01, 1.0, 0.0, 0.0}, run, {2.0, 0.01, 2.0});
  EXPECT_TRUE(relaxation.settled());
}

struct Pulled {
  bool held{};
  std::string relaxation;
};

/// A strip that is pulled, held at its other end or not.
TEST(relaxation, of_a_model_ends_at_its_static_answer_or_not_at_all) {
  std::vector<Pulled> cases;
  for (const std::string& relaxation : methods) {
    cases.push_back({true, relaxation});
    cases.push_back({false, relaxation});
  }
  for (const auto& [held, relaxation] : cases) {
    SCOPED_TRACE(relaxation);
    model::Description d = test::description({1000.0, 1.0e6, 0.0}, 0.1);
    d.run.analysis = "static";
    d.run.relaxation = relaxation;
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
class relaxation_of_a_model : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(methods, relaxation_of_a_model, testing::ValuesIn(methods),
                         [](const auto& method) { return method.param; });

TEST_P(relaxation_of_a_model, with_prescribed_displacements_ends_in_balance) {
  model::Description d = test::description({1000.0, 1.0e6, 0.0}, 0.1);
  d.run.analysis = "static";
  d.run.relaxation = GetParam();
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
  EXPECT_LT(simulation.extremes().energy_error, 0.01);
}

/// A strip of one element across that swings in its lowest mode, which takes few steps.
model::Description swinging_strip(const std::string& relaxation) {
  model::Description d = test::description({1000.0, 1.0e6, 0.0}, 0.1);
  d.run.analysis = "static";
  d.run.relaxation = relaxation;
  test::add_body(d, "strip", model::Plate{4.0, 1.0, 4, 1, "one"});
  test::add_box_set(d, "left", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::add_box_set(d, "right", {3.99, -1.0, -1.0}, {4.01, 2.0, 1.0});
  test::fix(d, "left", {"x"});
  d.forces.push_back({"right", {10.0, 0.0, 0.0}, {}, true, "", {}});
  return d;
}

// The quarter of a period is but some steps here, less than an epoch has at most.
TEST(relaxation, that_is_kinetic_has_epochs_short_enough_to_meet_the_peaks) {
  const model::Model model = test::build(swinging_strip("kinetic"));
  Simulation simulation(model, solve::KernelChoice::automatic);
  while (!simulation.relaxation().settled() && simulation.state().time < 60.0) {
    ASSERT_EQ(simulation.run_epoch(60.0).fault.kind, FaultKind::none);
  }
  EXPECT_TRUE(simulation.relaxation().settled());
  // A few lowest periods 4 L/c.
  EXPECT_LT(simulation.state().time, 8.0 * 16.0 / std::sqrt(1000.0));
}

// Whether motion is to be stopped, and which method is at hand, are carried along.
TEST_P(relaxation_of_a_model, goes_on_from_a_snapshot_to_the_same_bits) {
  const model::Model model = test::build(swinging_strip(GetParam()));
  Simulation whole(model, solve::KernelChoice::automatic);
  std::vector<Bytes> pieces;
  int stops = 0;
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(whole.run_epoch(60.0).fault.kind, FaultKind::none);
    stops += whole.relaxation().stops() ? 1 : 0;
    pieces.push_back(whole.piece(whole.own_bodies()));
    hashes.push_back(model::state_hash(model, whole.state()));
  }
  EXPECT_EQ(stops > 0, GetParam() != "viscous");
  for (std::size_t i = 0; i + 1 < hashes.size(); ++i) {
    Simulation resumed(model, solve::KernelChoice::automatic, World::alone(), std::vector<Bytes>{pieces[i]});
    ASSERT_EQ(resumed.run_epoch(60.0).fault.kind, FaultKind::none);
    ASSERT_EQ(model::state_hash(model, resumed.state()), hashes[i + 1]) << "after epoch " << i;
  }
}

}  // namespace
}  // namespace fexp::cluster
