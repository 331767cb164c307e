// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "model/tie_forces.hpp"
#include "solve/tie_release.hpp"
#include "support/descriptions.hpp"
#include "support/ties.hpp"

namespace fexp {
namespace {

constexpr double layer = 0.05;

model::TieDescription& bond(model::Description& d, const std::string& set, const std::string& surface,
                            double strength) {
  test::name_nodes(d, set, set);
  model::TieDescription& t = test::tie(d, set, {surface});
  t.strength_normal = t.strength_shear = strength;
  return t;
}

/// A small plate on a larger one, in free motion. The spin pulls at the bond.
model::Description spinning(double strength) {
  auto d = test::description(test::rubber, layer);
  test::add_body(d, "lower", test::plate(1.0, 0.6, 6, 4));
  test::add_body(d, "upper", test::plate(0.5, 0.3, 5, 3)).translate = {0.45, 0.25, layer};
  bond(d, "upper", "lower", strength);
  const Vec3d rate{2.0, 1.0, 5.0};
  d.bodies[0].angular_velocity = d.bodies[1].angular_velocity = rate;
  d.bodies[0].velocity = {0.3, 0.2, 0.1};
  d.bodies[1].velocity = d.bodies[0].velocity + cross(rate, Vec3d{0.2, 0.1, layer});
  return d;
}

/// A block that is held, and a plate on it.
model::Description on_block(double strength) {
  auto d = test::description(test::rubber, layer);
  test::add_body(d, "block", test::plate(1.0, 0.8, 3, 2));
  test::add_body(d, "plate", test::plate(0.6, 0.4, 5, 4)).translate = {0.15, 0.15, layer};
  bond(d, "plate", "block", strength);
  test::name_nodes(d, "block", "block");
  test::fix(d, "block", {"x", "y", "z", "rx", "ry", "rz"});
  return d;
}

cluster::EpochReport run_until(cluster::Simulation& simulation, double duration) {
  cluster::EpochReport report;
  while (simulation.state().time < duration) {
    report = simulation.run_epoch(duration);
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.fault.kind != cluster::FaultKind::none) {
      break;
    }
  }
  return report;
}

std::int64_t broken(const cluster::Simulation& simulation) {
  return model::broken_ties(simulation.model(), simulation.state(), 0);
}

double total(const model::State& state) {
  double sum = 0.0;
  for (const model::NodeInertia& node : state.moving) {
    sum += node.mass;
  }
  return sum;
}

TEST(tie_breaking, keeps_masses_momenta_and_balances) {
  // As strong as leaves some, then as weak as leaves none.
  std::vector<std::int64_t> counts;
  for (const double strength : {4000.0, 20.0}) {
    for (const bool rotations : {true, false}) {
      auto d = spinning(strength);
      d.ties[0].rotations = rotations;
      const model::Model model = test::build(d);
      cluster::Simulation simulation(model, solve::KernelChoice::automatic);
      const double before = total(simulation.state());
      const double energy = simulation.present().diagnostics.energies.kinetic;
      run_until(simulation, 0.5);
      counts.push_back(broken(simulation));
      EXPECT_GT(counts.back(), 0);
      EXPECT_NEAR(total(simulation.state()), before, 1e-12 * before);
      EXPECT_LT(simulation.extremes().linear_momentum_error, 1e-12);
      EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-12);
      EXPECT_LT(simulation.extremes().energy_error, 5e-3);
      for (const double off : simulation.watchdog().off()) {
        EXPECT_LT(std::abs(off), 5e-3 * energy);
      }
      // Breaking itself is no source worth speaking of.
      for (const model::BodyLedger& ledger : simulation.state().ledger) {
        EXPECT_LT(std::abs(ledger.external_work), 0.03 * energy);
      }
    }
  }
  EXPECT_LT(counts[0], 24);
  EXPECT_LT(counts[1], 24);
  EXPECT_EQ(counts[2], 24);
}

TEST(tie_breaking, gives_every_node_its_own_mass_back_to_the_bit) {
  const model::Model model = test::build(spinning(20.0));
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_EQ(simulation.state().moving[at(model.ties.ties[0].node)].mass, 0.0);
  run_until(simulation, 0.5);
  ASSERT_EQ(broken(simulation), 24);
  for (Index n = 0; n < model.node_count(); ++n) {
    EXPECT_EQ(simulation.state().moving[at(n)].mass, model.mass[at(n)]);
    EXPECT_EQ(simulation.state().moving[at(n)].inertia, model.inertia[at(n)]);
    EXPECT_NEAR(simulation.workspace().inverse_inertia[at(n)].mass * model.mass[at(n)], 1.0, 1e-15);
  }
}

TEST(tie_breaking, does_not_come_where_strengths_are_not_reached) {
  const model::Model weak = test::build(spinning(1.0e9));
  auto d = spinning(-1.0);
  const model::Model strong = test::build(d);
  cluster::Simulation a(weak, solve::KernelChoice::automatic), b(strong, solve::KernelChoice::automatic);
  EXPECT_TRUE(b.state().moving.empty());
  run_until(a, 0.1);
  run_until(b, 0.1);
  EXPECT_EQ(broken(a), 0);
  // The step knows of what may break; motions are those of the same bodies.
  for (Index n = 0; n < weak.node_count(); ++n) {
    EXPECT_LT(norm(a.state().motion[at(n)].position - b.state().motion[at(n)].position), 1e-4);
  }
}

TEST(tie_breaking, takes_the_sum_of_both_squares_and_no_pressure) {
  const model::Model model = test::build(on_block(1.0));
  model::State state = model::initial_state(model);
  const model::Tie& tie = model.ties.ties[0];
  ASSERT_TRUE(tie.held);
  ASSERT_FALSE(tie.is_fixed());
  const double n = tie.normal_strength, s = tie.shear_strength;
  const auto breaks = [&](double x, double z) {
    state.ties[0].force = {x, 0.0, z};
    return model::is_beyond_strength(model, state, 0.0, 0);
  };
  EXPECT_TRUE(breaks(0.0, 1.0001 * n));
  EXPECT_FALSE(breaks(0.0, 0.9999 * n));
  EXPECT_FALSE(breaks(0.0, -100.0 * n));
  EXPECT_TRUE(breaks(-1.0001 * s, 0.0));
  EXPECT_FALSE(breaks(0.9999 * s, -100.0 * n));
  EXPECT_TRUE(breaks(0.6001 * s, 0.8001 * n));
  EXPECT_FALSE(breaks(0.5999 * s, 0.7999 * n));
}

TEST(tie_breaking, goes_by_the_one_strength_that_is_given) {
  auto d = on_block(1.0);
  d.ties[0].strength_shear = -1.0;
  EXPECT_EQ(test::build(d).ties.ties[0].shear_strength, HUGE_VAL);
  EXPECT_LT(test::build(d).ties.ties[0].normal_strength, HUGE_VAL);
  d.ties[0].strength_shear = 1.0;
  d.ties[0].strength_normal = -1.0;
  EXPECT_LT(test::build(d).ties.ties[0].shear_strength, HUGE_VAL);
  EXPECT_EQ(test::build(d).ties.ties[0].normal_strength, HUGE_VAL);
}

TEST(tie_breaking, shares_the_tied_area_among_nodes) {
  const auto sum = [](const model::Description& d) {
    double area = 0.0;
    for (const model::Tie& tie : test::build(d).ties.ties) {
      area += tie.normal_strength;
    }
    return area;
  };
  auto d = on_block(1.0);  // A face
  EXPECT_NEAR(sum(d), 0.24, 1e-13);
  test::add_box_set(d, "seam", {0.74, -1.0, -1.0}, {0.76, 1.0, 1.0});  // An edge of 0.4, of the thickness 0.05
  d.ties[0].set = "seam";
  EXPECT_NEAR(sum(d), 0.4 * layer, 1e-14);
  test::add_box_set(d, "spot", {0.14, 0.14, 0.04}, {0.16, 0.16, 1.0});  // A corner, with elements of 0.12 x 0.1 / 2
  d.ties[0].set = "spot";
  const model::Model model = test::build(d);
  const auto& starts = model.corner_start;
  const Index node = model.ties.ties[0].node;
  EXPECT_NEAR(sum(d), 0.006 / 3.0 * (starts[at(node) + 1] - starts[at(node)]), 1e-15);
}

TEST(tie_breaking, lets_contact_go_on_without_a_jump) {
  // Pulled off and thrown back: the block stops the plate as far away as it was glued.
  for (const double gap : {layer, 0.6 * layer}) {
    auto d = on_block(100.0);
    d.contact.enabled = true;
    d.bodies[1].translate.z = gap;
    d.curves.push_back({"pull", {{0.0, 1.0}, {0.08, 1.0}, {0.0801, -1.0}, {1.0, -1.0}}, {}});
    d.gravity.push_back({{0.0, 0.0, 20.0}, "pull", {}});
    d.run.epoch_steps = 1;
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    double lowest = HUGE_VAL, highest = 0.0;
    Index first_pairs = -1;
    while (simulation.state().time < 0.3) {
      const cluster::EpochReport report = simulation.run_epoch(0.3);
      ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
      if (broken(simulation) == 30 && first_pairs < 0) {
        first_pairs = report.active_pairs;
      }
      for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
        lowest = std::min(lowest, simulation.state().motion[at(n)].position.z);
        highest = std::max(highest, simulation.state().motion[at(n)].position.z);
      }
    }
    EXPECT_EQ(first_pairs, 0);
    EXPECT_GT(highest, 2.0 * layer);
    EXPECT_GT(lowest, 0.5 * gap);
    EXPECT_LT(lowest, gap);
    EXPECT_GT(simulation.extremes().most_active_pairs, 0);
  }
}

TEST(tie_breaking, leaves_contact_out_where_nodes_were_on_the_very_triangle) {
  auto d = on_block(100.0);
  d.contact.enabled = true;
  d.bodies[1].translate.z = 0.0;
  d.gravity.push_back({{0.0, 0.0, 60.0}, "", {}});
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run_until(simulation, 0.1);
  EXPECT_EQ(broken(simulation), 30);
  EXPECT_EQ(simulation.extremes().most_active_pairs, 0);
  for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
    EXPECT_NEAR(simulation.state().motion[at(n)].position.z, 0.5 * 60.0 * 0.01, 2e-3);
  }
}

TEST(tie_breaking, parts_the_islands) {
  auto d = spinning(20.0);
  d.contact.enabled = false;
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_EQ(simulation.present().islands, 1);
  const cluster::EpochReport report = run_until(simulation, 0.5);
  ASSERT_EQ(broken(simulation), 24);
  EXPECT_EQ(report.islands, 2);
}

TEST(tie_breaking, has_a_step_that_is_stable_whatever_is_left) {
  // Nodes on the surface itself bring mass to carriers, those off it moments of mass: with both, and some gone, the
  // ratio may be larger than with all.
  auto d = test::description(test::rubber, 0.1);
  test::add_body(d, "lower", test::plate(0.8, 0.8, 8, 8));
  test::add_body(d, "upper", test::plate(0.8, 0.8, 8, 8)).translate = {0.0, 0.0, 0.1};
  bond(d, "upper", "lower", 6000.0);
  d.run.safety = 1.0;
  test::add_box_set(d, "corner", {-0.01, -0.01, -0.01}, {0.01, 0.01, 0.11});
  d.initial_velocities.push_back({"corner", {0.5, 0.3, 1.0}, 0.0, {0.0, 0.0, 1.0}, {}, {}});
  const model::Model model = test::build(d);
  ASSERT_FALSE(model.ties.blocks.empty());
  EXPECT_LT(model.ties.blocks[0].ratio, 2.0);
  d.ties[0].strength_normal = d.ties[0].strength_shear = -1.0;
  EXPECT_GE(model.ties.blocks[0].ratio, test::build(d).ties.blocks[0].ratio);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run_until(simulation, 1.0);
  EXPECT_GT(broken(simulation), 0);
  EXPECT_LT(broken(simulation), 81);
  EXPECT_LT(simulation.extremes().energy_error, 0.05);
}

TEST(tie_breaking, releases_a_node_with_both_momenta) {
  auto d = spinning(1.0);
  const model::Model model = test::build(d);
  model::State state = model::initial_state(model);
  // Any motion of the carriers, not only that of a rigid body.
  for (Index n = 0; n < model.bodies[0].nodes.end; ++n) {
    model::NodeMotion& motion = state.motion[at(n)];
    motion.velocity += Vec3d{std::sin(7.0 * n), std::sin(3.0 * n), std::cos(5.0 * n)};
    motion.rotation_rate += Vec3d{std::cos(2.0 * n), std::sin(11.0 * n), std::sin(n)};
  }
  const auto momenta = [&] {
    solve::Diagnostics sum;
    for (Index b = 0; b < 2; ++b) {
      sum += solve::motion_diagnostics(model, state, b);
    }
    return sum;
  };
  for (const model::Tie& tie : model.ties.ties) {
    const solve::Diagnostics before = momenta();
    const solve::Release release = solve::release_tied_node(model, tie, state);
    const solve::Diagnostics after = momenta();
    EXPECT_EQ(norm(release.impulse), 0.0);
    EXPECT_LT(norm(after.momenta.linear - before.momenta.linear), 1e-12 * before.momenta.linear_scale);
    EXPECT_LT(norm(after.momenta.angular - before.momenta.angular - release.angular_impulse),
              1e-12 * before.momenta.angular_scale);
  }
  // With conditions at its carriers a node leaves them as they are, and the difference is told.
  state = model::initial_state(model);
  model::Tie tie = model.ties.ties[0];
  tie.conditions = true;
  const solve::Diagnostics before = momenta();
  const Vec3d carrier = state.motion[at(tie.carrier[0])].velocity;
  const solve::Release release = solve::release_tied_node(model, tie, state);
  const solve::Diagnostics after = momenta();
  EXPECT_EQ(state.motion[at(tie.carrier[0])].velocity, carrier);
  EXPECT_GT(norm(release.impulse), 0.0);
  EXPECT_LT(norm(after.momenta.linear - before.momenta.linear - release.impulse), 1e-12 * before.momenta.linear_scale);
  EXPECT_LT(norm(after.momenta.angular - before.momenta.angular - release.angular_impulse),
            1e-12 * before.momenta.angular_scale);
}

TEST(tie_breaking, with_conditions_at_carriers_closes_the_books) {
  auto d = spinning(100.0);
  d.bodies[0].velocity = d.bodies[0].angular_velocity = d.bodies[1].velocity = d.bodies[1].angular_velocity = {};
  test::name_nodes(d, "lower", "lower");
  d.curves.push_back({"jerk", {{0.0, 0.0}, {0.02, 1.0}, {1.0, 1.0}}, {}});
  d.prescribed.push_back({"lower", "z", -3.0, "jerk", {}});
  d.prescribed.push_back({"lower", "ry", 4.0, "jerk", {}});
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  run_until(simulation, 0.1);
  EXPECT_GT(broken(simulation), 0);
  EXPECT_LT(simulation.extremes().linear_momentum_error, 1e-11);
  EXPECT_LT(simulation.extremes().angular_momentum_error, 1e-11);
  EXPECT_LT(simulation.extremes().energy_error, 0.01);
}

TEST(tie_breaking, is_refused_on_rigid_bodies_that_move) {
  auto d = spinning(1.0);
  d.bodies[0].rigid = true;
  std::vector<model::Mesh> meshes;
  for (const model::BodyDescription& body : d.bodies) {
    meshes.push_back(model::generate_mesh(std::get<model::MeshGenerator>(body.mesh)));
  }
  ErrorList errors;
  static_cast<void>(model::build_model(d, meshes, errors));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors.errors()[0].text().find("has a strength, and body \"lower\" of its surface is rigid and moves"),
            std::string::npos);
  auto held = on_block(1.0);
  held.bodies[0].rigid = true;
  EXPECT_TRUE(test::build(held).ties.ties[0].held);
}

TEST(tie_breaking, of_some_nodes_gives_the_least_step_that_is_asked_for) {
  // Ties take a part of the step; elements at them get mass for that as well.
  for (const double strength : {-1.0, 1.0e9}) {
    auto d = test::description(test::rubber, 0.1);
    test::add_body(d, "lower", test::plate(0.8, 0.8, 8, 8));
    test::add_body(d, "upper", test::plate(0.8, 0.8, 8, 8)).translate = {0.0, 0.0, 0.1};
    bond(d, "upper", "lower", strength);
    const double usual = test::build(d).first_step();
    for (const double factor : {0.95, 1.0, 3.0}) {
      d.run.minimum_step = factor * usual;
      const model::Model model = test::build(d);
      cluster::Simulation simulation(model, solve::KernelChoice::automatic);
      const double step = model.run.safety * simulation.present().critical.step;
      EXPECT_GE(step, d.run.minimum_step * (1.0 - 1e-12)) << factor;
      EXPECT_LT(step, 1.01 * d.run.minimum_step) << factor;
    }
    d.run.minimum_step = 0.5 * usual;  // Which all have
    EXPECT_TRUE(test::build(d).step_factor.empty());
  }
}

}  // namespace
}  // namespace fexp
