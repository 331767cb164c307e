// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "cluster/simulation.hpp"
#include "physics/critical_step.hpp"
#include "physics/shell_damping.hpp"
#include "solve/diagnostics.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using physics::ShellIncrement;
using physics::ShellResultants;

const physics::ShellStiffness stiffness(physics::ShellSection{0.1, physics::LinearElastic{1.0, 3.0, 0.3}.moduli(),
                                                              0.1});
const ShellIncrement<double> increment{1.0, -2.0, 3.0, 4.0, 5.0, -6.0, 7.0, 8.0, {0.1, -0.2, 0.3}};

std::array<double, 11> values_of(const ShellResultants<double>& r) {
  return {r.nxx, r.nyy, r.nxy, r.mxx, r.myy, r.mxy, r.qxz, r.qyz, r.drill[0], r.drill[1], r.drill[2]};
}

TEST(stiffness_damping, adds_what_the_elastic_law_makes_of_the_rate_and_books_its_work) {
  ShellResultants<double> elastic{}, share{};
  ShellIncrement<double> tiny = increment;  // So small that nothing turns
  for (double* const value : {&tiny.exx, &tiny.eyy, &tiny.gxy, &tiny.kxx, &tiny.kyy, &tiny.kxy, &tiny.gxz, &tiny.gyz,
                              &tiny.drill[0], &tiny.drill[1], &tiny.drill[2]}) {
    *value *= 1e-14;
  }
  physics::update_elastic(stiffness, 0.5, tiny, elastic);
  physics::update_damping(stiffness, 20.0, 0.5, tiny, 0.0, share);
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_NEAR(values_of(share)[i], 20.0 * values_of(elastic)[i], 1e-12 * std::abs(values_of(share)[i])) << i;
  }
  // From nothing, half of what a constant share takes; then the whole of it.
  EXPECT_NEAR(share.energy, 20.0 * elastic.energy, 1e-12 * share.energy);
  const double first = share.energy;
  physics::update_damping(stiffness, 20.0, 0.5, tiny, 0.0, share);
  EXPECT_NEAR(share.energy, 3.0 * first, 1e-12 * first);
}

TEST(stiffness_damping, of_an_element_ends_when_it_fails) {
  ShellResultants<double> share{};
  physics::update_damping(stiffness, 20.0, 0.5, increment, 0.0, share);
  const double before = share.energy;
  physics::update_damping(stiffness, 20.0, 0.5, increment, 1.0, share);
  EXPECT_NEAR(share.energy, 2.0 * before, 1e-12 * before);  // The old share, once more half of it
  for (const double value : values_of(share)) {
    EXPECT_EQ(value, 0.0);
  }
  const double failed = share.energy;
  ShellIncrement<double> ruin = increment;
  ruin.exx = ruin.drill[1] = std::nan("");
  physics::update_damping(stiffness, 20.0, std::nan(""), ruin, 2.0, share);
  EXPECT_EQ(share.energy, failed);
  for (const double value : values_of(share)) {
    EXPECT_EQ(value, 0.0);
  }
}

TEST(damped_frequency, gives_the_critical_step_of_damped_central_differences) {
  for (const double omega : {1e-3, 1.0, 7e5}) {
    for (const double xi : {0.0, 1e-3, 0.5, 40.0}) {
      const double exact = 2.0 / omega * (std::sqrt(1.0 + xi * xi) - xi);
      const double found = 2.0 / physics::damped_frequency(omega * omega, 0.0, 2.0 * xi / omega);
      EXPECT_NEAR(found, exact, 1e-12 * (1.0 + 2.0 * xi * xi) * exact);
    }
  }
  EXPECT_EQ(physics::damped_frequency(9.0, 16.0, 0.0), 5.0);
  EXPECT_EQ(physics::damped_frequency(HUGE_VAL, 1.0, 0.0), HUGE_VAL);
  // What is not damped counts as it does without damping.
  EXPECT_EQ(physics::damped_frequency(0.0, 16.0, 0.3), 4.0);
}

/// One element, free, that vibrates at random with a step of `part` of the critical one.
double energy_after(double part, double damping, int steps) {
  auto d = test::description(test::steel, 0.001);
  d.run.stiffness_damping = damping;
  d.run.safety = 1.0;
  test::add_body(d, "plate", model::Plate{0.3, 0.2, 1, 1, "one"});
  model::Model model = test::build(d);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    model.initial_velocity[n] = 1e-9 * Vec3d{unit(random), unit(random), unit(random)};
    model.initial_rotation_rate[n] = 1e-9 * Vec3d{unit(random), unit(random), unit(random)};
  }
  test::DirectRun run(model);
  run.advance(part * model.first_step(), steps);
  const solve::Diagnostics end = solve::diagnostics(model, run.state);
  return end.energies.kinetic + end.energies.internal;
}

// The bound of a free element exceeds the frequency of two that are joined by little.
TEST(stiffness_damping, is_stable_up_to_the_critical_step_and_not_far_beyond) {
  for (const double damping : {1e-7, 1e-5, 1e-3}) {
    const double start = energy_after(0.01, damping, 0);
    EXPECT_LT(energy_after(0.999, damping, 20000), start) << damping;
    // It may have grown beyond all numbers.
    EXPECT_FALSE(energy_after(1.5, damping, 200) < 1e6 * start) << damping;
  }
}

TEST(stiffness_damping, makes_the_steps_of_a_run_shorter_by_what_it_takes) {
  auto d = test::description(test::steel, 0.01);
  d.run.duration = 1e-4;
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 5, 4, "one"});
  const model::Model plain = test::build(d);
  EXPECT_EQ(plain.first_step(), d.run.safety * plain.first_critical_step);
  d.run.stiffness_damping = 3.0 * plain.first_critical_step;
  const model::Model damped = test::build(d);
  EXPECT_EQ(damped.first_critical_step, plain.first_critical_step);
  EXPECT_NEAR(damped.first_step(), plain.first_step() * (std::sqrt(10.0) - 3.0), 1e-12 * plain.first_step());
  cluster::Simulation simulation(damped, solve::KernelChoice::automatic);
  const cluster::EpochReport report = simulation.run_epoch(HUGE_VAL);
  EXPECT_NEAR(report.dt, damped.first_step(), 1e-6 * damped.first_step());
  // Mass scaling reaches the step that was asked for with the damping.
  d.run.minimum_step = 1.7 * damped.first_step();
  const model::Model scaled = test::build(d);
  EXPECT_NEAR(scaled.first_step(), d.run.minimum_step, 1e-12 * d.run.minimum_step);
}

/// A plate that spins fast and is hit at a corner.
TEST(stiffness_damping, neither_brakes_rotation_nor_changes_momenta_and_is_in_the_balance) {
  for (const bool shaken : {false, true}) {
    SCOPED_TRACE(shaken);
    auto d = test::description(test::rubber, 0.02);
    d.run.stiffness_damping = 2e-3;
    model::BodyDescription& body = test::add_body(d, "plate", model::Plate{1.0, 0.6, 10, 6, "one"});
    body.angular_velocity = {0.5, 0.8, 1.0};
    model::Model model = test::build(d);
    if (shaken) {
      model.initial_velocity[0].z += 3.0;
      model.initial_velocity[0].x -= 1.0;
    }
    test::DirectRun run(model);
    const solve::Diagnostics start = solve::diagnostics(model, run.state);
    const double dt = 0.5 * model.first_step();
    run.advance(dt, static_cast<Index>(0.5 / dt));
    const solve::Diagnostics end = solve::diagnostics(model, run.state);
    const double kinetic = start.energies.kinetic;
    EXPECT_LT(norm(end.momenta.linear - start.momenta.linear), 1e-11 * start.momenta.linear_scale);
    EXPECT_LT(norm(end.momenta.angular - start.momenta.angular), 1e-11 * start.momenta.angular_scale);
    EXPECT_NEAR(end.energies.balance(), start.energies.balance(), 2e-3 * kinetic);
    if (shaken) {
      EXPECT_GT(end.energies.damping, 0.1 * kinetic);
    } else {
      EXPECT_LT(end.energies.damping, 0.01 * kinetic);  // What stretching by the spin takes
    }
  }
}

TEST(stiffness_damping, of_zero_needs_no_memory_and_gives_the_same_bits) {
  auto d = test::description(test::rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 0.6, 10, 6, "one"}).angular_velocity = {0.5, 0.8, 1.0};
  const model::Model plain = test::build(d);
  EXPECT_TRUE(model::initial_state(plain).damping.empty());
  d.run.stiffness_damping = 1e-30;
  const model::Model damped = test::build(d);
  test::DirectRun a(plain), b(damped);
  a.advance(0.5 * plain.first_step(), 100);
  b.advance(0.5 * plain.first_step(), 100);
  EXPECT_EQ(b.state.damping.size(), b.state.history.size());
  for (Index n = 0; n < plain.node_count(); ++n) {
    EXPECT_EQ(norm(a.state.motion[at(n)].position - b.state.motion[at(n)].position), 0.0);
  }
  EXPECT_GT(solve::diagnostics(damped, b.state).energies.damping, 0.0);
}

}  // namespace
}  // namespace fexp
