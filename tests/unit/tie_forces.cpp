// SPDX-License-Identifier: Apache-2.0
#include "model/tie_forces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "cluster/simulation.hpp"
#include "model/capture.hpp"
#include "support/descriptions.hpp"
#include "support/ties.hpp"

namespace fexp {
namespace {

constexpr double height = 0.05;

void hold(model::Description& d, const std::string& set) { test::fix(d, set, {"x", "y", "z", "rx", "ry", "rz"}); }

/// A strip that stands out from a block under it, to which its root of 0.2 x 0.2 is glued, and is loaded at its end.
model::Description bracket() {
  auto d = test::description(test::rubber, height);
  test::add_body(d, "block", test::plate(0.3, 0.3, 2, 2)).translate = {-0.1, -0.05, 0.0};
  test::add_body(d, "strip", test::plate(1.0, 0.2, 10, 2)).translate = {0.0, 0.0, height};
  test::add_box_set(d, "root", {-0.01, -0.01, 0.01}, {0.21, 0.21, 1.0});
  test::add_box_set(d, "tip", {0.99, -0.01, 0.01}, {1.01, 0.21, 1.0});
  test::name_nodes(d, "block", "block");
  test::tie(d, "root", {"block"});
  d.forces.push_back({"tip", {0.3, 0.2, 0.5}, {}, true, "", {}});
  d.run.analysis = "static";
  d.run.duration = 1000.0;
  d.run.residual = 1.0e-8;
  return d;
}

void rest(cluster::Simulation& simulation) {
  while (simulation.state().time < 1000.0 && !simulation.relaxation().settled()) {
    const cluster::EpochReport report = simulation.run_epoch(1000.0);
    ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  }
}

/// What is expected of a bracket at rest: the load, and its moment about the mean place of the root's nodes.
void expect_load(const model::Model& model, const model::State& state) {
  const model::TieResultant sum = model::tie_resultant(model, state, 0);
  const Vec3d load{0.3, 0.2, 0.5};
  EXPECT_LT(norm(sum.force - load), 1e-5);
  Vec3d root, tip;
  for (const model::Tie& tie : model.ties.ties) {
    root += (1.0 / static_cast<double>(model.ties.ties.size())) * state.motion[at(tie.node)].position;
  }
  for (const model::NamedNodes& set : model.node_sets) {
    for (const Index n : set.nodes) {
      if (set.name == "tip") {
        tip += (1.0 / static_cast<double>(set.nodes.size())) * state.motion[at(n)].position;
      }
    }
  }
  // The forces at the tip are one third each, and all of them turn alike.
  EXPECT_LT(norm(sum.moment - cross(tip - root, load)), 2e-5 * norm(sum.moment));
}

TEST(tie_forces, are_the_load_of_a_bracket_on_whatever_carries_it) {
  {
    auto d = bracket();  // On a block that is held altogether, for ever or by glue that could break
    hold(d, "block");
    for (const double strength : {-1.0, 1.0e9}) {
      d.ties[0].strength_normal = strength;
      const model::Model model = test::build(d);
      EXPECT_EQ(model.ties.ties[0].is_fixed(), strength < 0.0);
      cluster::Simulation simulation(model, solve::KernelChoice::automatic);
      rest(simulation);
      expect_load(model, simulation.state());
    }
  }
  {
    auto d = bracket();  // On one that deforms
    test::add_box_set(d, "back", {-0.11, -1.0, -0.01}, {-0.09, 1.0, 0.01});
    hold(d, "back");
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    rest(simulation);
    expect_load(model, simulation.state());
  }
  {
    auto d = bracket();  // On a rigid one that is told to stay where it is
    d.bodies[0].rigid = true;
    test::fix(d, "block", {"y", "z", "rx", "ry", "rz"});
    d.prescribed.push_back({"block", "x", 0.0, "", {}});
    const model::Model model = test::build(d);
    ASSERT_NE(model.ties.ties[0].rigid, no_index);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    rest(simulation);
    expect_load(model, simulation.state());
  }
}

TEST(tie_forces, move_the_masses_that_are_glued_on) {
  // Two equal plates glued all over; a pressure pushes the lower one down: half of it goes through the glue.
  auto d = test::description(test::rubber, height);
  test::add_body(d, "lower", test::plate(0.6, 0.4, 3, 2));
  test::add_body(d, "upper", test::plate(0.6, 0.4, 3, 2)).translate = {0.0, 0.0, height};
  test::name_nodes(d, "upper", "upper");
  test::tie(d, "upper", {"lower"});
  d.pressure.push_back({{"lower"}, "", 100.0, "", {}});
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const auto check = [&] {
    const model::TieResultant sum = model::tie_resultant(model, simulation.state(), 0);
    EXPECT_NEAR(sum.force.z, 0.5 * 100.0 * 0.24, 1e-9);
    EXPECT_NEAR(sum.normal, 0.5 * 100.0 * 0.24, 1e-9);
  };
  check();
  // And nothing where both fall.
  d.pressure.clear();
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  const model::Model falling = test::build(d);
  cluster::Simulation fall(falling, solve::KernelChoice::automatic);
  EXPECT_LT(norm(model::tie_resultant(falling, fall.state(), 0).force), 1e-12 * 0.24 * height * 1000.0 * 9.81);
}

TEST(tie_forces, of_a_node_have_a_side_that_pulls) {
  auto d = test::description(test::rubber, height);
  test::add_body(d, "lower", test::plate(1.0, 1.0, 1, 1));
  test::add_body(d, "upper", test::plate(0.2, 0.2, 1, 1)).translate = {0.5, 0.2, height};
  test::name_nodes(d, "upper", "upper");
  test::tie(d, "upper", {"lower"});
  for (const double side : {1.0, -1.0}) {
    d.bodies[1].translate.z = side * height;
    const model::Model model = test::build(d);
    model::State state = model::initial_state(model);
    state.ties[0].force = {3.0, 4.0, 2.0};
    model::TieForce force = model::tie_force(model, state, 0.0, 0);
    EXPECT_NEAR(force.normal, side * 2.0, 1e-14);
    EXPECT_NEAR(force.shear, 5.0, 1e-14);
    // What moves the node's mass does not go through the tie.
    state.acceleration[at(model.ties.ties[0].node)].linear = {0.0, 0.0, 1.0 / model.mass[at(model.ties.ties[0].node)]};
    force = model::tie_force(model, state, 0.0, 0);
    EXPECT_NEAR(force.normal, side * 1.0, 1e-14);
    state.ties[0].broken = 1;
    EXPECT_EQ(norm(model::tie_force(model, state, 0.0, 0).force), 0.0);
  }
  // On the very triangle both sides pull.
  d.bodies[1].translate.z = 0.0;
  const model::Model model = test::build(d);
  model::State state = model::initial_state(model);
  for (const double z : {2.0, -2.0}) {
    state.ties[0].force = {0.0, 0.0, z};
    EXPECT_NEAR(model::tie_force(model, state, 0.0, 0).normal, 2.0, 1e-14);
  }
}

TEST(tie_forces, are_in_the_results_of_their_nodes) {
  auto d = bracket();
  d.ties[0].strength_normal = 1.0;
  const model::Model model = test::build(d);
  model::State state = model::initial_state(model);
  state.ties[0].force = {1.0, 2.0, 3.0};
  state.ties[1].force = {4.0, 5.0, 6.0};
  state.ties[1].broken = 1;
  const model::Frame frame = model::capture(model, state, {}, {});
  const std::size_t holds = at(model.ties.ties[0].node), broken = at(model.ties.ties[1].node);
  EXPECT_EQ(frame.tied[holds], 1);
  EXPECT_EQ(frame.tie_force[holds], (std::array{1.0F, 2.0F, 3.0F}));
  EXPECT_EQ(frame.tied[broken], 0);
  EXPECT_EQ(frame.tie_force[broken], (std::array<float, 3>{}));
  EXPECT_EQ(frame.tied[0], 0);  // Of the block
  EXPECT_EQ(std::accumulate(frame.tied.begin(), frame.tied.end(), 0), static_cast<int>(model.ties.ties.size()) - 1);
}

/// Largest drifts of the balances of carriers and of tied bodies, which come first, over the energy of the model, at
/// the ends of all epochs.
std::array<double, 2> worst_drifts(const model::Model& model, double duration) {
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  std::array<double, 2> worst{};
  double energy = 0.0;
  while (simulation.state().time < duration) {
    const cluster::EpochReport report = simulation.run_epoch(duration);
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.fault.kind != cluster::FaultKind::none) {
      return {HUGE_VAL, HUGE_VAL};
    }
    energy = std::max(energy, report.diagnostics.energies.kinetic + report.diagnostics.energies.internal);
    for (std::size_t b = 0; b < 2; ++b) {
      worst[b] = std::max(worst[b], std::abs(simulation.watchdog().off()[b]));
    }
  }
  const std::vector<double>& work = simulation.state().tie_work;
  EXPECT_GT(std::abs(work[0]), 0.01 * energy);  // That there is work to be booked
  EXPECT_LE(std::abs(work[0] + work[1]), 1e-12 * std::abs(work[0]));
  return {worst[0] / energy, worst[1] / energy};
}

TEST(tie_forces, do_work_that_closes_the_balance_of_each_body) {
  for (const bool rotations : {true, false}) {
    auto d = test::description(test::rubber, height);
    test::add_body(d, "lower", test::plate(1.0, 0.6, 6, 4));
    test::add_body(d, "upper", test::plate(0.5, 0.3, 5, 3)).translate = {0.25, 0.15, height};
    d.bodies[1].velocity = {0.0, 0.0, 2.0};
    test::name_nodes(d, "upper", "upper");
    test::tie(d, "upper", {"lower"});
    d.ties[0].rotations = rotations;
    d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
    test::add_box_set(d, "edge", {-0.01, -1.0, -0.01}, {0.01, 1.0, 0.01});
    test::fix(d, "edge", {"x", "y", "z", "ry"});
    // What is left is of the arms that turn in a step, and goes with its square at least.
    const std::array<double, 2> usual = worst_drifts(test::build(d), 0.5);
    d.run.safety *= 0.5;
    const std::array<double, 2> half = worst_drifts(test::build(d), 0.5);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_LT(usual[b], 2e-5) << rotations << b;
      EXPECT_LT(half[b], 0.4 * usual[b]) << rotations << b;
    }
  }
}

TEST(tie_forces, do_work_on_rigid_bodies_that_closes_their_balance) {
  auto d = test::description(test::rubber, height);
  test::add_body(d, "block", test::plate(0.3, 0.3, 2, 2)).rigid = true;
  test::add_body(d, "strip", test::plate(0.8, 0.2, 8, 3)).translate = {0.31, 0.05, 0.02};
  d.bodies[1].velocity = {0.0, 0.0, 1.0};
  d.node_sets.emplace_back().name = "root";
  d.node_sets.back().bodies = {"strip"};
  d.node_sets.back().box = model::BoxSelection{{0.3, -1.0, -1.0}, {0.32, 1.0, 1.0}};
  test::tie(d, "root", {"block"});
  d.ties[0].distance = 0.05;
  const std::array<double, 2> drifts = worst_drifts(test::build(d), 0.5);
  EXPECT_LT(drifts[0], 1e-4);
  EXPECT_LT(drifts[1], 1e-4);
}

}  // namespace
}  // namespace fexp
