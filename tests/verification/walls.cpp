// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solve/diagnostics.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using std::numbers::pi;
using test::verify;

constexpr double thickness = 0.02;

/// A flat plate of mass 20 with its centre in the origin.
model::Description plate(bool rigid) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, thickness);
  model::BodyDescription& body = test::add_body(d, "plate", model::Plate{1.0, 1.0, 4, 4, "one"});
  body.translate = {-0.5, -0.5, 0.0};
  body.rigid = rigid;
  return d;
}

/// A plane that touches every node is accelerated from rest: the plate follows it on the springs k_i = kappa m_i of its
/// nodes as one oscillator, z'' = kappa (w - z), with w = a t^2/2: the force is m a (1 - cos(omega t)).
TEST(moving_plane, pushes_a_plate_with_its_mass_times_the_acceleration) {
  for (const bool rigid : {false, true}) {
    auto d = plate(rigid);
    d.curves.push_back({"ramp", {{0.0, 0.0}, {9.0, 9.0}}, {}});
    const double acceleration = 50.0;
    d.planes.push_back({"pusher", {0.0, 0.0, -0.5 * thickness}, {0.0, 0.0, 1.0}, -1.0, {}, {}, {}, ""});
    d.planes[0].velocity = {0.0, 0.0, acceleration};
    d.planes[0].curve = "ramp";
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    const double frequency = 0.3 / model.first_critical_step, dt = 0.01 * pi / frequency;
    double sum = 0.0, largest = 0.0, open = 0.0;
    const int steps = 2000;  // Ten periods
    for (int i = 0; i < steps; ++i) {
      run.advance(dt, 1);
      const double force = run.workspace.actions[0].wall_force[0].z;
      sum += force / steps;
      largest = std::max(largest, force);
      const solve::Energies e = solve::diagnostics(model, run.state).energies;
      open = std::max(open, std::abs(e.balance()) / std::max(e.external, 1e-3));
    }
    const double mass = model.bodies[0].mass;
    const std::string title = std::string(rigid ? "rigid" : "elastic") + " plate on a moving plane";
    verify({"55", title, "mean force [N]", mass * acceleration, sum, 2e-3, true, "m a"});
    verify({"55", title, "largest force [N]", 2.0 * mass * acceleration, largest, 2e-3, true, "2 m a"});
    verify({"55", title, "energy error at any time", 0.0, open, 1e-3, false, "balance"});
  }
}

/// A ball with one lowest node, in each of the walls.
model::Description ball_of_mass(double mass, double radius) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.01);
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{radius, 4});
  ball.rigid = true;
  ball.mass = mass;
  return d;
}

struct Case {
  const char* name;
  Vec3d from;  ///< Direction in which the ball comes to the wall
  bool sphere;
  bool inside;
};

TEST(round_walls, throw_a_rigid_ball_back_and_let_it_rest_by_the_closed_forms) {
  const double radius = 0.1, mass = 2.0, stiffness = 2.0e6, big = 1.0, half = 0.005;
  for (const Case& c :
       {Case{"outside of a sphere", {0, 0, -1}, true, false}, Case{"inside of a sphere", {0, 0, -1}, true, true},
        Case{"outside of a cylinder", {0, 0, -1}, false, false},
        Case{"inside of a cylinder", {0, 0, -1}, false, true}}) {
    auto d = ball_of_mass(mass, radius);
    // The wall's nearest point to the ball is the origin.
    const Vec3d centre{0.0, 0.0, c.inside ? big : -big};
    if (c.sphere) {
      d.spheres.push_back({"wall", centre, big, c.inside, stiffness, {}, {}, {}, ""});
    } else {
      d.cylinders.push_back({"wall", centre, {0.0, 1.0, 0.0}, big, c.inside, stiffness, {}, {}, {}, ""});
    }
    d.bodies[0].translate = {0.0, 0.0, radius + half + 1e-5};
    d.bodies[0].velocity = {0.0, 0.0, -1.0};
    const double frequency = std::sqrt(stiffness / mass);
    {
      const model::Model model = test::build(d);
      test::DirectRun run(model);
      double deepest = 0.0;
      while (run.state.time < 0.006) {
        run.advance(0.02 / frequency, 1);
        deepest = std::max(deepest, radius + half - run.state.rigid[0].centre.z);
      }
      verify({"56", c.name, "deepest penetration [mm]", 1e3 / frequency, 1e3 * deepest, 1e-3, true, "v sqrt(m/k)"});
      verify({"56", c.name, "velocity out / in", 1.0, run.state.rigid[0].velocity.z, 1e-3, true, "exact"});
    }
    d.bodies[0].velocity = {};
    d.bodies[0].translate.z = radius + half;
    d.gravity.push_back({{0.0, 0.0, -10.0}, "", {}});
    d.run.damping = 2.0 * frequency;
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    run.advance(0.02 / frequency, 2000);
    verify({"56", c.name, "penetration at rest [mm]", 1e3 * mass * 10.0 / stiffness,
            1e3 * (radius + half - run.state.rigid[0].centre.z), 1e-6, true, "m g/k"});
  }
}

/// A sphere that comes with a velocity throws a ball at rest off with twice that.
TEST(round_walls, that_move_throw_a_ball_off_with_twice_their_velocity) {
  auto d = ball_of_mass(2.0, 0.1);
  d.spheres.push_back({"racket", {0.0, 0.0, -1.10501}, 1.0, false, 2.0e6, {}, {0.0, 0.0, 3.0}, {}, ""});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  run.advance(2.0e-5, 300);
  const solve::Energies e = solve::diagnostics(model, run.state).energies;
  verify({"57", "ball struck by a moving sphere", "velocity / the sphere's", 2.0, run.state.rigid[0].velocity.z / 3.0,
          1e-3, true, "exact"});
  verify({"57", "ball struck by a moving sphere", "work of the wall / kinetic energy", 1.0, e.external / e.kinetic,
          1e-3, true, "balance"});
}

}  // namespace
}  // namespace fexp
