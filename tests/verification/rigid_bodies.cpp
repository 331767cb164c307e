// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cluster/simulation.hpp"
#include "solve/diagnostics.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using std::numbers::pi;
using test::verify;

/// Jacobi's elliptic functions sn, cn and dn by the arithmetic-geometric mean [AS64 16.4].
std::array<double, 3> elliptic(double u, double square_of_k) {
  std::array<double, 12> a{}, c{};
  a[0] = 1.0;
  c[0] = std::sqrt(square_of_k);
  double b = std::sqrt(1.0 - square_of_k);
  std::size_t n = 0;
  for (; n + 1 < a.size() && std::abs(c[n]) > 1e-16; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  double before = phi;
  for (; n > 0; --n) {
    before = phi;
    phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  }
  const double sn = std::sin(phi), cn = std::cos(phi);
  return {sn, cn, cn / std::cos(before - phi)};
}

/// Euler's equations without moments for I1 < I2 < I3 and L^2 > 2 E I2, in the principal axes, with no rate about the
/// second at first [L. D. Landau, E. M. Lifshitz, Mechanics, sec. 37].
Vec3d euler_rates(const std::array<double, 3>& inertia, const Vec3d& first, double time) {
  const auto& [i1, i2, i3] = inertia;
  const double energy2 = i1 * first.x * first.x + i3 * first.z * first.z;
  const double momentum2 = i1 * i1 * first.x * first.x + i3 * i3 * first.z * first.z;
  const double p = std::sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3));
  const double k2 = (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1));
  const auto [sn, cn, dn] = elliptic(p * time, k2);
  return {std::sqrt((energy2 * i3 - momentum2) / (i1 * (i3 - i1))) * cn,
          std::sqrt((energy2 * i3 - momentum2) / (i2 * (i3 - i2))) * sn,
          std::sqrt((momentum2 - energy2 * i1) / (i3 * (i3 - i1))) * dn};
}

/// A rigid plate of 3 x 2, whose principal axes lie askew.
model::Description thrown_plate() {
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.02);
  model::BodyDescription& body = test::add_body(d, "plate", model::Plate{3.0, 2.0, 12, 8, "one"});
  body.rigid = true;
  body.rotate.push_back({{1.0, 2.0, -1.0}, 40.0, {}});
  return d;
}

struct Tumble {
  Vec3d rate;  ///< At the end, in the principal axes
  double energy_error{};
  double momentum_error{};
};

Tumble tumble(const model::Model& model, const Vec3d& first, double time, int steps) {
  const model::RigidBody& rigid = model.rigid_bodies[0];
  model::State start = model::initial_state(model);
  start.rigid[0].angular_momentum =
      inertia_times(rigid, first.x * rigid.axis[0] + first.y * rigid.axis[1] + first.z * rigid.axis[2]);
  test::DirectRun run(model, start);
  const solve::Diagnostics before = solve::diagnostics(model, run.state);
  Tumble result;
  for (int i = 0; i < steps; ++i) {
    run.advance(time / steps, 1);
    const solve::Diagnostics now = solve::diagnostics(model, run.state);
    result.energy_error = std::max(result.energy_error, std::abs(now.energies.kinetic / before.energies.kinetic - 1.0));
    result.momentum_error = std::max(result.momentum_error,
                                     norm(now.momenta.angular - before.momenta.angular) / norm(before.momenta.angular));
  }
  const Vec3d rate = rotated(inverse(run.state.rigid[0].orientation), rotation_rate(rigid, run.state.rigid[0]));
  result.rate = {dot(rate, rigid.axis[0]), dot(rate, rigid.axis[1]), dot(rate, rigid.axis[2])};
  return result;
}

TEST(rigid_plate, tumbles_as_eulers_equations_say) {
  const model::Model model = test::build(thrown_plate());
  const Vec3d first{6.0, 0.0, 8.0};
  const double time = 3.0;
  const Vec3d exact = euler_rates(model.rigid_bodies[0].inertia, first, time);
  const Tumble coarse = tumble(model, first, time, 1500), fine = tumble(model, first, time, 3000);
  const std::string title = "rigid plate, tumbling freely";
  verify({"50", title, "rate about the middle axis", exact.y, fine.rate.y, 2e-4, true, "Jacobi's elliptic functions"});
  verify({"50", title, "error of all rates / their size", 0.0, norm(fine.rate - exact) / norm(exact), 1e-4, false,
          "Jacobi's elliptic functions"});
  verify({"50", title, "error at twice the step / error", 4.0, norm(coarse.rate - exact) / norm(fine.rate - exact),
          0.05, true, "second order"});
  verify({"50", title, "energy error at any time", 0.0, fine.energy_error, 1e-5, false, "exact"});
  verify({"50", title, "energy error at twice the step / it", 4.0, coarse.energy_error / fine.energy_error, 0.05, true,
          "second order"});
  verify({"50", title, "angular momentum error", 0.0, fine.momentum_error, 1e-14, false, "exact"});
}

TEST(rigid_plate, spins_for_a_hundred_turns_without_an_error_of_phase) {
  auto d = thrown_plate();
  d.bodies[0].rotate.clear();
  d.bodies[0].angular_velocity = {0.0, 0.0, 2.0 * pi};
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  run.advance(0.01, 10000);
  double largest = 0.0;
  for (Index n = 0; n < model.node_count(); ++n) {
    largest = std::max(largest, norm(run.state.motion[at(n)].position - model.reference_position[at(n)]));
  }
  verify({"51", "rigid plate, 100 turns of 100 steps", "way of any node / length", 0.0, largest / 3.0, 1e-8, false,
          "exact"});
}

TEST(rigid_plate, falls_like_a_stone) {
  auto d = thrown_plate();
  d.bodies[0].velocity = {1.0, 0.0, 4.0};
  d.bodies[0].angular_velocity = {5.0, 1.0, 2.0};
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double start = solve::diagnostics(model, run.state).energies.balance();
  run.advance(0.001, 1000);
  const Vec3d way = run.state.rigid[0].centre - model.rigid_bodies[0].centre;
  const double error = norm(way - Vec3d{1.0, 0.0, 4.0 - 0.5 * 9.81});
  verify({"52", "rigid plate, thrown up", "error of the way after 1 s", 0.0, error, 1e-12, false, "v t - g t^2/2"});
  const solve::Diagnostics end = solve::diagnostics(model, run.state);
  verify({"52", "rigid plate, thrown up", "energy error", 0.0,
          std::abs(end.energies.balance() - start) / end.energies.kinetic, 1e-6, false, "balance"});
}

/// A bounce on the one lowest node: half a period of the mass on the spring of the plane.
TEST(rigid_ball, bounces_off_a_plane_like_a_mass_off_a_spring) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.01);
  d.bodies.clear();
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.1, 4});
  ball.rigid = true;
  ball.mass = 2.0;
  ball.velocity = {0.0, 0.0, -1.0};
  ball.translate = {0.0, 0.0, 0.1051};
  const double stiffness = 2.0e6;
  d.planes.push_back({{"floor", stiffness}, {}, {0.0, 0.0, 1.0}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double frequency = std::sqrt(stiffness / 2.0), dt = 0.02 / frequency;
  double deepest = 0.0, contact = 0.0;
  while (run.state.time < 0.006) {
    run.advance(dt, 1);
    deepest = std::max(deepest, 0.1 + 0.005 - run.state.rigid[0].centre.z);
    contact += run.state.rigid[0].force.z > 0.0 ? dt : 0.0;
  }
  const std::string title = "rigid ball, bounce on a plane";
  verify({"53", title, "contact time [ms]", 1e3 * pi / frequency, 1e3 * contact, 1e-2, true, "pi sqrt(m/k)"});
  verify({"53", title, "deepest penetration [mm]", 1e3 / frequency, 1e3 * deepest, 1e-3, true, "v sqrt(m/k)"});
  verify({"53", title, "velocity out / in", 1.0, run.state.rigid[0].velocity.z, 1e-3, true, "exact"});
}

TEST(rigid_ball, dropped_on_an_elastic_plate_gives_it_its_momentum) {
  auto d = test::description({1000.0, 1.0e7, 0.3}, 0.01);
  d.contact.enabled = true;
  d.run.safety = 0.5;
  d.run.energy_drift_limit = 1.0;
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.1, 5});
  ball.rigid = true;
  ball.translate = {0.52, 0.47, 0.115};
  ball.velocity = {0.3, 0.1, -5.0};
  ball.angular_velocity = {2.0, -3.0, 1.0};
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 20, 20, "one"});
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  while (simulation.state().time < 0.02) {
    const auto report = simulation.run_epoch(0.02);
    ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  }
  const auto& x = simulation.extremes();
  EXPECT_GT(x.most_active_pairs, 0);
  EXPECT_GT(simulation.state().rigid[0].velocity.z, -3.0) << "the plate has taken up much of it";
  const std::string title = "rigid ball on an elastic plate";
  verify({"54", title, "linear momentum error", 0.0, x.linear_momentum_error, 1e-12, false, "exact"});
  verify({"54", title, "angular momentum error", 0.0, x.angular_momentum_error, 1e-12, false, "exact"});
  verify({"54", title, "energy error", 0.0, x.energy_error, 5e-3, false, "balance"});
}

}  // namespace
}  // namespace fexp
