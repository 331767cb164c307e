// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using std::numbers::pi;
using test::verify;

constexpr double length = 20.0, density = 7.4e-4, young = 30.0e6;

/// A strip that is held lengthwise at its end x = 0 and begins to move with the speed sin(beta x / length).
model::Description swinging_strip() {
  auto d = test::description({density, young, 0.0}, 0.1);
  test::add_body(d, "strip", model::Plate{length, 1.0, 80, 4, "one"});
  test::add_box_set(d, "root", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::add_box_set(d, "tip", {length - 0.01, -1.0, -1.0}, {length + 0.01, 2.0, 1.0});
  test::fix(d, "root", {"x"});
  return d;
}

struct Crossing {
  double time{};   ///< When the tip is where it was at first
  double speed{};  ///< Its speed then
};

/// The first `count` returns of the tip in the direction in which it set out.
std::vector<Crossing> returns_of(model::Model model, double beta, std::size_t count) {
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    model.initial_velocity[n].x = std::sin(beta * model.reference_position[n].x / length);
  }
  const std::vector<Index> end = test::nodes_of(model, "tip");
  const Index tip = *std::find_if(end.begin(), end.end(),
                                  [&](Index n) { return std::abs(model.reference_position[at(n)].y - 0.5) < 1e-9; });
  test::DirectRun run(model);
  const double dt = 0.5 * model.first_critical_step;
  std::vector<Crossing> crossings;
  while (crossings.size() < count && run.state.time < 1.0) {
    const double time = run.state.time, before = run.state.motion[at(tip)].position.x - length;
    const double speed = run.state.motion[at(tip)].velocity.x;
    run.advance(dt, 1);
    const double now = run.state.motion[at(tip)].position.x - length;
    if (before < 0.0 && now >= 0.0) {
      const double part = before / (before - now);
      crossings.push_back({time + part * dt, speed + part * (run.state.motion[at(tip)].velocity.x - speed)});
    }
  }
  return crossings;
}

TEST(tip_mass, on_a_strip_makes_it_swing_as_slowly_as_the_frequency_equation_says) {
  // beta tan(beta) = m/M by Newton's method for a mass twice that of the strip.
  double beta = 0.6;
  for (int i = 0; i < 50; ++i) {
    beta -= (beta * std::tan(beta) - 0.5) / (std::tan(beta) + beta / (std::cos(beta) * std::cos(beta)));
  }
  auto d = swinging_strip();
  d.point_masses.push_back({"tip", 2.0 * density * 0.1 * length, 0.0, true, {}});
  const std::vector<Crossing> found = returns_of(test::build(d), beta, 2);
  ASSERT_EQ(found.size(), 2U);
  const double exact = 2.0 * pi * length / (beta * std::sqrt(young / density));
  verify({"33", "strip with a tip mass, 80 x 4 cells", "period [us]", 1e6 * exact,
          1e6 * (found[1].time - found[0].time), 1e-3, true, "beta tan beta = m/M"});
}

TEST(damped_strip, loses_the_exponential_of_half_the_coefficient) {
  const double frequency = 0.5 * pi / length * std::sqrt(young / density);
  auto d = swinging_strip();
  d.run.damping = 0.1 * frequency;
  const std::vector<Crossing> found = returns_of(test::build(d), 0.5 * pi, 4);
  ASSERT_EQ(found.size(), 4U);
  const double damped = frequency * std::sqrt(1.0 - 0.05 * 0.05);
  const std::string title = "damped strip, xi = 0.05";
  verify({"34", title, "period [us]", 1e6 * 2.0 * pi / damped, 1e6 * (found[3].time - found[0].time) / 3.0, 1e-3, true,
          "2 pi / (omega sqrt(1 - xi^2))"});
  verify({"34", title, "speed after 3 periods / first", std::exp(-0.5 * d.run.damping * 6.0 * pi / damped),
          found[3].speed / found[0].speed, 2e-3, true, "exp(-alpha t / 2)"});
}

/// Of a strip that is simply supported at its ends and swings in its bending mode of `half_waves`.
struct Swing {
  double frequency{};  ///< Over time, as it is damped [1/time]
  double decrement{};  ///< Logarithm of the ratio of velocities one period apart
};

Swing swing(int half_waves, double stiffness_damping, double damping) {
  auto d = test::description({density, young, 0.0}, 0.5);
  d.run.stiffness_damping = stiffness_damping;
  d.run.damping = damping;
  test::add_body(d, "strip", model::Plate{length, 1.0, 24, 1, "one"});
  test::add_box_set(d, "left", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::add_box_set(d, "right", {length - 0.01, -1.0, -1.0}, {length + 0.01, 2.0, 1.0});
  test::fix(d, "left", {"x", "y", "z"});
  test::fix(d, "right", {"z"});
  const double wave = half_waves * pi / length, crest = 0.5 * length / half_waves;
  test::add_box_set(d, "crest", {crest - 0.01, -0.1, -1.0}, {crest + 0.01, 0.1, 1.0});
  model::Model model = test::build(d);
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    const double x = model.reference_position[n].x;
    model.initial_velocity[n].z = 1e-3 * std::sin(wave * x);
    model.initial_rotation_rate[n].y = -1e-3 * wave * std::cos(wave * x);
  }
  const Index crest_node = test::nodes_of(model, "crest")[0];
  test::DirectRun run(model);
  const double dt = 0.9 * model.first_step();
  std::vector<Crossing> crossings;
  while (crossings.size() < 3 && run.state.step < 1000000) {
    const model::NodeMotion before = run.state.motion[at(crest_node)];
    const double time = run.state.time;
    run.advance(dt, 4);
    const model::NodeMotion& now = run.state.motion[at(crest_node)];
    if (before.position.z < 0.0 && now.position.z >= 0.0) {
      const double part = before.position.z / (before.position.z - now.position.z);
      crossings.push_back(
          {time + part * (run.state.time - time), before.velocity.z + part * (now.velocity.z - before.velocity.z)});
    }
  }
  EXPECT_EQ(crossings.size(), 3U);
  const double period = 0.5 * (crossings[2].time - crossings[0].time);
  return {2.0 * pi / period, 0.5 * std::log(crossings[0].speed / crossings[2].speed)};
}

// Damping by the stiffness goes up with the frequency, damping by the mass down.
TEST(bending_modes, lose_what_both_kinds_of_damping_take_at_their_frequencies) {
  const double first = pi * pi / (length * length) * std::sqrt(young / density / 12.0) * 0.5;
  const double beta = 0.02 / first, alpha = 0.02 * first;
  const auto decrement = [](double xi) { return 2.0 * pi * xi / std::sqrt(1.0 - xi * xi); };
  const std::string title = "supported strip, 24 x 1 cells";
  std::vector<Swing> by_stiffness, by_mass;
  for (const int mode : {1, 2}) {
    const double omega = swing(mode, 0.0, 0.0).frequency;
    verify({"58", title, "frequency of mode " + std::to_string(mode), mode * mode * first, omega, 0.02, true,
            "m^2 pi^2 sqrt(EI / rho A) / L^2"});
    by_stiffness.push_back(swing(mode, beta, 0.0));
    by_mass.push_back(swing(mode, 0.0, alpha));
    verify({"58", title, "decrement by stiffness, mode " + std::to_string(mode), decrement(0.5 * beta * omega),
            by_stiffness.back().decrement, 1e-4, true, "xi = beta omega / 2"});
    verify({"58", title, "decrement by mass, mode " + std::to_string(mode), decrement(0.5 * alpha / omega),
            by_mass.back().decrement, 0.01, true, "xi = alpha / (2 omega)"});
  }
  verify({"58", title, "decrements by stiffness, mode 2 over 1", 4.0,
          by_stiffness[1].decrement / by_stiffness[0].decrement, 0.03, true, "omega2 / omega1"});
  verify({"58", title, "decrements by mass, mode 2 over 1", 0.25, by_mass[1].decrement / by_mass[0].decrement, 0.03,
          true, "omega1 / omega2"});
}

TEST(prescribed_displacement, is_followed_to_rounding) {
  auto d = swinging_strip();
  d.curves.push_back({"there and back", {{0.0, 0.0}, {1.0e-4, 1.0}, {2.5e-4, -0.5}}, {}});
  model::Prescribed moved;
  moved.set = "tip";
  moved.dof = "x";
  moved.displacement = 0.02;
  moved.curve = "there and back";
  d.prescribed.push_back(moved);
  const model::Model model = test::build(d);
  const Index tip = test::nodes_of(model, "tip")[0];
  test::DirectRun run(model);
  double largest = 0.0;
  while (run.state.time < 3.0e-4) {
    run.advance(0.4 * model.first_critical_step, 1);
    const double wanted = length + 0.02 * model::curve_value(model, 0, run.state.time);
    largest = std::max(largest, std::abs(run.state.motion[at(tip)].position.x - wanted));
  }
  verify({"35", "prescribed displacement", "largest error / length", 0.0, largest / length, 1e-15, false, "the curve"});
}

}  // namespace
}  // namespace fexp
