// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "contact/initial_penetrations.hpp"
#include "model/tie_motion.hpp"
#include "quality/assess.hpp"
#include "support/descriptions.hpp"
#include "support/ties.hpp"

namespace fexp {
namespace {

using test::add_body;
using test::name_nodes;
using test::rubber;
using test::tie;

constexpr double thickness = 0.05;

/// A small plate glued on top of a larger one, both in one free rigid motion.
model::Description glued(double gap = thickness) {
  auto d = test::description(rubber, thickness);
  add_body(d, "lower", test::plate(1.0, 0.6, 6, 4));
  add_body(d, "upper", test::plate(0.5, 0.3, 5, 3)).translate = {0.25, 0.15, gap};
  name_nodes(d, "upper", "upper");
  tie(d, "upper", {"lower"});
  const Vec3d rate{2.0, 1.0, 5.0};
  d.bodies[0].angular_velocity = d.bodies[1].angular_velocity = rate;
  d.bodies[0].velocity = {0.3, 0.2, 0.1};
  d.bodies[1].velocity = d.bodies[0].velocity + cross(rate, Vec3d{0.0, 0.0, gap});
  return d;
}

std::vector<std::string> errors_of(const model::Description& d) {
  std::vector<model::Mesh> meshes;
  for (const model::BodyDescription& body : d.bodies) {
    meshes.push_back(model::generate_mesh(std::get<model::MeshGenerator>(body.mesh)));
  }
  ErrorList errors;
  static_cast<void>(model::build_model(d, meshes, errors));
  std::vector<std::string> texts;
  for (const InputError& error : errors.errors()) {
    texts.push_back(error.text());
  }
  return texts;
}

void expect_error(const model::Description& d, const std::string& part) {
  const std::vector<std::string> texts = errors_of(d);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_NE(texts[0].find(part), std::string::npos) << texts[0];
}

cluster::EpochReport run(cluster::Simulation& simulation, double duration) {
  cluster::EpochReport report;
  while (simulation.state().time < duration) {
    report = simulation.run_epoch(duration, 0);
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.fault.kind != cluster::FaultKind::none) {
      break;
    }
  }
  return report;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) {
    total += value;
  }
  return total;
}

/// Largest distance of a tied node from the end of an arm of the reference length, over the arm's length or 1.
double worst_arm(const model::Model& model, const model::State& state) {
  double worst = 0.0;
  for (const model::Tie& t : model.ties.ties) {
    Vec3d arm = state.motion[at(t.node)].position;
    for (std::size_t a = 0; a < 3; ++a) {
      arm -= t.weight[a] * state.motion[at(t.carrier[a])].position;
    }
    worst = std::max(worst, std::abs(norm(arm) - t.length));
  }
  return worst;
}

TEST(ties, hand_all_mass_to_carriers_and_keep_the_sum) {
  const model::Model model = test::build(glued());
  ASSERT_EQ(model.ties.ties.size(), 24U);
  EXPECT_NEAR(sum(model.ties.mass), sum(model.mass), 1e-12 * sum(model.mass));
  for (const model::Tie& t : model.ties.ties) {
    EXPECT_EQ(model.ties.mass[at(t.node)], 0.0);
    EXPECT_EQ(model.ties.inertia[at(t.node)], 0.0);
    EXPECT_NEAR(t.weight[0] + t.weight[1] + t.weight[2], 1.0, 1e-15);
    EXPECT_GE(*std::min_element(t.weight.begin(), t.weight.end()), 0.0);
    EXPECT_NEAR(t.length, thickness, 1e-15);
  }
  const double arms = thickness * thickness * model.bodies[1].mass;
  EXPECT_NEAR(sum(model.ties.inertia), sum(model.inertia) + arms, 1e-12 * sum(model.inertia));
}

TEST(ties, are_no_penetrations_at_the_start) {
  // Nearer than thicknesses allow, and a web that stands on the mid-surface and, at its ends, cuts it.
  auto d = glued(0.5 * thickness);
  d.contact.enabled = true;
  EXPECT_TRUE(contact::find_initial_penetrations(test::build(d), test::build(d).reference_position).pairs.empty());
  model::BodyDescription& web = add_body(d, "web", test::plate(0.3, 0.2, 3, 2));
  web.rotate.push_back({{1.0, 0.0, 0.0}, -90.0, {}});
  web.translate = {0.3, 0.05, 0.001};
  test::add_box_set(d, "edge", {0.0, 0.0, -0.01}, {1.0, 0.1, 0.01});
  d.node_sets.back().bodies = {"web"};
  tie(d, "edge", {"lower"});
  const model::Model tied = test::build(d);
  EXPECT_TRUE(contact::find_initial_penetrations(tied, tied.reference_position).crossings.empty());
  d.ties.clear();
  const model::Model untied = test::build(d);
  EXPECT_FALSE(contact::find_initial_penetrations(untied, untied.reference_position).pairs.empty());
  EXPECT_FALSE(contact::find_initial_penetrations(untied, untied.reference_position).crossings.empty());
}

TEST(ties, are_told_as_what_joins_bodies) {
  auto d = glued(0.0);
  d.bodies[1].mesh = test::plate(0.5, 0.3, 3, 2);  // Of the same cells as the lower one, on whose nodes its own lie
  d.bodies[1].translate = {1.0 / 6.0, 0.15, 0.0};
  const auto kinds_of = [](const model::Description& described) {
    const model::Model model = test::build(described);
    std::vector<std::string_view> kinds;
    for (const auto& found : {quality::near_nodes(model), quality::overlapping_shells(model)}) {
      for (const quality::Finding& finding : found) {
        kinds.push_back(finding.kind);
      }
    }
    return kinds;
  };
  EXPECT_TRUE(kinds_of(d).empty());
  d.ties.clear();
  EXPECT_EQ(kinds_of(d), (std::vector<std::string_view>{"unjoined_bodies", "overlapping_shells"}));
}

TEST(ties, that_are_hinges_leave_nodes_their_own_inertia) {
  auto d = glued();
  d.ties[0].rotations = false;
  const model::Model model = test::build(d);
  for (const model::Tie& t : model.ties.ties) {
    EXPECT_EQ(model.ties.inertia[at(t.node)], model.inertia[at(t.node)]);
  }
}

TEST(ties, keep_momenta_energy_and_arms_in_free_motion) {
  for (const bool rotations : {true, false}) {
    auto d = glued();
    d.ties[0].rotations = rotations;
    d.contact.enabled = true;
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    const double before = simulation.present().diagnostics.energies.balance();
    const cluster::EpochReport report = run(simulation, 1.0);
    const cluster::RunExtremes& extremes = simulation.extremes();
    EXPECT_LT(extremes.linear_momentum_error, 1e-11);
    EXPECT_LT(extremes.angular_momentum_error, 1e-11);
    EXPECT_LT(extremes.energy_error, 5e-3);
    EXPECT_NEAR(report.diagnostics.energies.balance(), before, 5e-3 * before);
    EXPECT_EQ(extremes.most_active_pairs, 0);  // Contact does not act between what is tied
    EXPECT_LT(worst_arm(model, simulation.state()), 1e-12);
  }
}

TEST(ties, of_coincident_nodes_are_as_one_mesh) {
  // A strip in one piece and one of two that are tied node to node vibrate alike.
  auto d = test::description(rubber, thickness);
  add_body(d, "whole", test::plate(1.0, 0.2, 10, 2));
  add_body(d, "left", test::plate(0.5, 0.2, 5, 2)).translate = {0.0, 1.0, 0.0};
  add_body(d, "right", test::plate(0.5, 0.2, 5, 2)).translate = {0.5, 1.0, 0.0};
  test::add_box_set(d, "roots", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::fix(d, "roots", {"x", "y", "z", "rx", "ry", "rz"});
  d.node_sets.emplace_back().name = "seam";
  d.node_sets.back().bodies = {"right"};
  d.node_sets.back().box = model::BoxSelection{{0.49, 0.9, -1.0}, {0.51, 1.3, 1.0}};
  tie(d, "seam", {"left"});
  d.gravity.push_back({{1.0, 2.0, -3.0}, "", {}});
  const model::Model model = test::build(d);
  ASSERT_EQ(model.ties.ties.size(), 3U);
  EXPECT_TRUE(model.ties.blocks.empty());  // No arms, no smaller step
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run(simulation, 0.3);
  double worst = 0.0, largest = 0.0;
  for (Index n = model.bodies[0].nodes.begin; n < model.bodies[0].nodes.end; ++n) {
    const Vec3d& place = model.reference_position[at(n)];
    const Vec3d way = simulation.state().motion[at(n)].position - place;
    largest = std::max(largest, norm(way));
    for (Index m = model.bodies[1].nodes.begin; m < model.bodies[2].nodes.end; ++m) {
      if (norm(model.reference_position[at(m)] - place - Vec3d{0.0, 1.0, 0.0}) < 1e-9) {
        const Vec3d other = simulation.state().motion[at(m)].position - model.reference_position[at(m)];
        worst = std::max(worst, norm(other - way));
      }
    }
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(worst, 1e-9 * largest);
}

TEST(ties, to_a_rigid_body_move_with_it) {
  auto d = glued();
  d.bodies[0].rigid = true;
  const model::Model model = test::build(d);
  ASSERT_EQ(model.rigid_bodies.size(), 1U);
  const double mass = model.bodies[0].mass + model.bodies[1].mass;
  EXPECT_NEAR(model.rigid_bodies[0].mass, mass, 1e-12 * mass);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run(simulation, 1.0);
  EXPECT_LT(simulation.extremes().energy_error, 1e-3);
  EXPECT_LT(simulation.extremes().linear_momentum_error, 1e-11);
  EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-11);
  // Both bodies keep all distances, as all nodes of the upper one are tied.
  const auto& motion = simulation.state().motion;
  for (Index n = 1; n < model.node_count(); ++n) {
    const double was = norm(model.reference_position[at(n)] - model.reference_position[0]);
    EXPECT_NEAR(norm(motion[at(n)].position - motion[0].position), was, 1e-12);
  }
}

TEST(ties, swing_a_strip_from_a_rigid_body_and_keep_the_balance) {
  auto d = test::description(rubber, thickness);
  add_body(d, "block", test::plate(0.3, 0.3, 2, 2)).rigid = true;
  add_body(d, "strip", test::plate(0.8, 0.2, 8, 3)).translate = {0.31, 0.05, 0.02};
  d.bodies[1].velocity = {0.0, 0.0, 1.0};
  d.node_sets.emplace_back().name = "root";
  d.node_sets.back().bodies = {"strip"};
  d.node_sets.back().box = model::BoxSelection{{0.3, -1.0, -1.0}, {0.32, 1.0, 1.0}};
  for (const bool rotations : {true, false}) {
    d.ties.clear();
    tie(d, "root", {"block"}).rotations = rotations;
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    run(simulation, 0.5);
    EXPECT_LT(simulation.extremes().energy_error, 5e-3);
    EXPECT_LT(simulation.extremes().linear_momentum_error, 1e-11);
    EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-11);
    EXPECT_LT(worst_arm(model, simulation.state()), 1e-12);
  }
}

TEST(ties, to_a_barrier_hold_nodes) {
  for (const bool rotations : {true, false}) {
    auto d = glued();
    d.ties[0].rotations = rotations;
    name_nodes(d, "lower", "lower");
    test::fix(d, "lower", {"x", "y", "z", "rx", "ry", "rz"});
    const model::Model model = test::build(d);
    EXPECT_TRUE(std::ranges::all_of(model.ties.ties, &model::Tie::is_fixed));
    EXPECT_TRUE(model.ties.joined.empty());
    EXPECT_EQ(model.ties.mass, model.mass);
    EXPECT_EQ(model.ties.results[0].tied, 24);
    EXPECT_EQ(model.bodies[1].fixed.size(), 24);
    EXPECT_EQ(model.bodies[1].barrier, rotations);
    EXPECT_EQ(model.fixed.back().mask, rotations ? 0x3F : 0x07);
  }
}

TEST(ties, to_held_nodes_of_a_body_that_moves_hold_nodes_there_only) {
  // The upper plate is tied to a lower one of which one half is held, a third one to what ties and conditions hold.
  auto d = glued();
  for (model::BodyDescription& body : d.bodies) {
    body.velocity = body.angular_velocity = {};
  }
  test::add_box_set(d, "half", {-0.01, -0.01, -0.01}, {0.51, 1.0, 0.01});
  test::fix(d, "half", {"x", "y", "z", "rx", "ry", "rz"});
  add_body(d, "third", test::plate(0.1, 0.1, 1, 1)).translate = {0.05, 0.05, thickness};
  name_nodes(d, "third", "third");
  tie(d, "third", {"lower"});
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  const model::Model model = test::build(d);
  EXPECT_TRUE(model.bodies[2].barrier);
  EXPECT_FALSE(model.bodies[1].barrier);
  EXPECT_GT(model.bodies[1].fixed.size(), 0);
  EXPECT_EQ(model.bodies[1].ties.size(), 24);
  const auto ties = std::span(model.ties.ties).subspan(at(model.bodies[1].ties.begin), 24);
  EXPECT_EQ(std::ranges::count_if(ties, &model::Tie::is_fixed), model.bodies[1].fixed.size());
  EXPECT_LT(model.bodies[1].fixed.size(), 24);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run(simulation, 0.2);
  EXPECT_LT(simulation.extremes().energy_error, 5e-3);
  EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-10);
  EXPECT_LT(worst_arm(model, simulation.state()), 1e-12);
}

TEST(ties, may_hang_on_carriers_that_are_driven) {
  // What is prescribed is fast and sets in at once: swept boxes of the tied body have to know of it.
  auto d = glued();
  for (model::BodyDescription& body : d.bodies) {
    body.velocity = body.angular_velocity = {};
  }
  name_nodes(d, "lower", "lower");
  d.prescribed.push_back({"lower", "x", 3.0, "", {}});
  d.prescribed.push_back({"lower", "z", 0.0, "", {}});
  d.prescribed.push_back({"lower", "ry", 2.0, "", {}});
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run(simulation, 0.1);
  EXPECT_LT(simulation.extremes().rollbacks, 10);
  EXPECT_LT(worst_arm(model, simulation.state()), 1e-12);
  const model::Tie& t = model.ties.ties.front();
  const Vec3d way = simulation.state().motion[at(t.node)].position - model.reference_position[at(t.node)];
  EXPECT_NEAR(way.x, 0.3 + thickness * std::sin(0.2), 1e-4);
  EXPECT_NEAR(way.z, thickness * (std::cos(0.2) - 1.0), 1e-4);
}

TEST(ties, join_islands_whether_there_is_contact_or_not) {
  auto d = glued();
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_EQ(simulation.present().islands, 1);
  d.ties.clear();
  const model::Model apart = test::build(d);
  EXPECT_EQ(cluster::Simulation(apart, solve::KernelChoice::automatic).present().islands, 2);
}

TEST(ties, have_a_step_that_is_stable_for_thick_shells) {
  // As thick as the elements are long, at the very critical step: masses at arms are as large as those of carriers.
  auto d = test::description(rubber, 0.1);
  add_body(d, "lower", test::plate(0.8, 0.8, 8, 8));
  add_body(d, "upper", test::plate(0.8, 0.8, 8, 8)).translate = {0.0, 0.0, 0.1};
  name_nodes(d, "upper", "upper");
  tie(d, "upper", {"lower"});
  d.run.safety = 1.0;
  // A jolt of one corner has all frequencies in it.
  test::add_box_set(d, "corner", {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.11});
  d.initial_velocities.push_back({"corner", {0.5, 0.3, 1.0}, 0.0, {0.0, 0.0, 1.0}, {}, {}});
  const model::Model model = test::build(d);
  ASSERT_FALSE(model.ties.blocks.empty());
  EXPECT_GT(model.ties.blocks[0].ratio, 1.1);
  EXPECT_LT(model.ties.blocks[0].ratio, 2.0);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_LT(simulation.present().critical.step, model.first_critical_step);
  run(simulation, 2.0);
  EXPECT_LT(simulation.extremes().energy_error, 0.04);
}

TEST(ties, say_which_nodes_are_too_far) {
  auto d = glued();
  d.bodies[1].rotate.push_back({{0.0, 1.0, 0.0}, -30.0, {}});
  d.ties[0].distance = 0.1;
  const model::Model model = test::build(d);
  const model::TieResult& result = model.ties.results[0];
  EXPECT_EQ(result.tied + static_cast<Index>(result.far.size()), 24);
  EXPECT_GT(result.tied, 0);
  EXPECT_GT(result.distance, 0.1);
  const auto findings = quality::far_tied_nodes(model);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].severity, quality::Severity::warning);
  EXPECT_EQ(findings[0].count, static_cast<std::int64_t>(result.far.size()));
  EXPECT_TRUE(quality::far_tied_nodes(test::build(glued())).empty());
}

TEST(ties, take_the_distance_of_touching_shells_by_default) {
  EXPECT_EQ(test::build(glued(1.04 * thickness)).ties.ties.size(), 24U);
  expect_error(glued(1.06 * thickness), "no node of set \"upper\" is near its surface, the closest is 0.053 away");
}

TEST(ties, refuse_what_has_no_meaning) {
  auto d = glued();
  d.ties[0].surface = {"nobody"};
  expect_error(d, "tie \"tie 1\" names body \"nobody\"");

  d = glued();
  d.ties[0].set = "nothing";
  expect_error(d, "there is no node set \"nothing\"");

  d = glued();
  d.ties[0].surface = {};
  expect_error(d, "names no body");

  d = glued();
  d.ties[0].surface = {"upper"};
  expect_error(d, "which is its surface");

  d = glued();
  d.bodies[1].rigid = true;
  expect_error(d, "which is rigid");

  d = glued();
  test::add_box_set(d, "one", {0.24, 0.14, 0.04}, {0.26, 0.16, 0.06});
  test::fix(d, "one", {"z"});
  expect_error(d, "has a condition besides");

  d = glued();
  tie(d, "upper", {"lower"});
  expect_error(d, "is tied already by tie \"tie 1\"");

  d = glued();
  tie(d, "upper", {"lower"}).name = "tie 1";
  expect_error(d, "the name \"tie 1\" is already that of another tie");

  d = glued();
  add_body(d, "third", test::plate(0.3, 0.2, 2, 2)).translate = {0.3, 0.2, 2.0 * thickness};
  name_nodes(d, "third", "third");
  tie(d, "third", {"upper"});
  expect_error(d, "which tie \"tie 1\" has tied itself");
}

TEST(ties, may_carry_one_body_on_two_others) {
  auto d = test::description(rubber, thickness);
  add_body(d, "left", test::plate(0.5, 0.4, 4, 4));
  add_body(d, "right", test::plate(0.5, 0.4, 3, 3)).translate = {0.6, 0.0, 0.0};
  add_body(d, "bridge", test::plate(0.4, 0.2, 6, 3)).translate = {0.35, 0.1, thickness};
  d.bodies[0].velocity = {0.0, 0.0, 1.0};
  name_nodes(d, "bridge", "bridge");
  tie(d, "bridge", {"left", "right"});
  const model::Model model = test::build(d);
  ASSERT_EQ(model.ties.bodies.size(), 2U);
  EXPECT_FALSE(model.ties.results[0].far.empty());  // Over the gap
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_EQ(simulation.present().islands, 1);
  run(simulation, 0.3);
  EXPECT_LT(simulation.extremes().energy_error, 5e-3);
  EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-11);
}

TEST(ties, turn_arms_by_the_rotation_whose_velocity_is_that_of_the_mean_arm) {
  model::Tie t;
  t.length = 2.0;
  const Vec3d arm{0.0, 2.0, 0.0}, angle{0.3, -0.2, 0.5};
  const Vec3d turned = model::turned_arm(t, arm, angle);
  EXPECT_NEAR(norm(turned), 2.0, 1e-15);
  EXPECT_LT(norm(turned - arm - cross(angle, 0.5 * (arm + turned))), 1e-15);
  EXPECT_EQ(norm(model::turned_arm(model::Tie{}, arm, angle)), 0.0);
}

}  // namespace
}  // namespace fexp
