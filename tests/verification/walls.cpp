// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

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
    d.planes.push_back({{"pusher"}, {0.0, 0.0, -0.5 * thickness}, {0.0, 0.0, 1.0}});
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
      d.spheres.push_back({{"wall", stiffness}, centre, big, c.inside});
    } else {
      d.cylinders.push_back({{"wall", stiffness}, centre, {0.0, 1.0, 0.0}, big, c.inside});
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
  d.spheres.push_back({{"racket", 2.0e6}, {0.0, 0.0, -1.10501}, 1.0});
  d.spheres[0].velocity = {0.0, 0.0, 3.0};
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  run.advance(2.0e-5, 300);
  const solve::Energies e = solve::diagnostics(model, run.state).energies;
  verify({"57", "ball struck by a moving sphere", "velocity / the sphere's", 2.0, run.state.rigid[0].velocity.z / 3.0,
          1e-3, true, "exact"});
  verify({"57", "ball struck by a moving sphere", "work of the wall / kinetic energy", 1.0, e.external / e.kinetic,
          1e-3, true, "balance"});
}

/// A rigid block of 2 kg with four nodes on a wall with friction, pressed in as deep as its weight does.
constexpr double block_mass = 2.0, wall_stiffness = 1.0e5, mu = 0.3, g = 9.81;

model::Description block_on_a_wall(const Vec3d& gravity) {
  auto d = test::description({2.0e4, 1.0e7, 0.3}, 0.01);
  model::BodyDescription& block = test::add_body(d, "block", model::Plate{0.1, 0.1, 1, 1, "one"});
  block.rigid = true;
  block.translate = {-0.05, -0.05, 0.005 + block_mass * gravity.z / (4.0 * wall_stiffness)};
  d.gravity.push_back({gravity, "", {}});
  return d;
}

model::RigidWall rubbing_wall() { return {"floor", wall_stiffness, mu, 0.2}; }

constexpr double block_step = 1.0e-4;  // Springs and nodes: omega dt = 0.045

TEST(friction_of_walls, stops_a_block_after_v_over_mu_g) {
  for (const bool plane : {true, false}) {
    auto d = block_on_a_wall({0.0, 0.0, -g});
    if (plane) {
      d.planes.push_back({rubbing_wall(), {}, {0.0, 0.0, 1.0}});
    } else {  // It slides along the axis, at the bottom of a cylinder so large that it is flat.
      d.cylinders.push_back({rubbing_wall(), {0.0, 0.0, 1.0e6}, {1.0, 0.0, 0.0}, 1.0e6, true});
    }
    d.bodies[0].velocity = {2.0, 0.0, 0.0};
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    double stands = 0.0, force = 0.0, open = 0.0;
    int sliding = 0;
    while (run.state.time < 0.8) {
      const double speed = run.state.rigid[0].velocity.x;
      run.advance(block_step, 1);
      if (run.state.rigid[0].velocity.x < 1.0e-3 && stands == 0.0) {
        stands = run.state.time -
                 block_step * (1.0e-3 - run.state.rigid[0].velocity.x) / (speed - run.state.rigid[0].velocity.x);
      }
      if (stands == 0.0) {
        force += run.workspace.actions[0].wall_force[0].x;
        ++sliding;
      }
      const solve::Energies e = solve::diagnostics(model, run.state).energies;
      open = std::max(open, std::abs(e.balance() - 0.5 * block_mass * 4.0) / (0.5 * block_mass * 4.0));
    }
    const solve::Energies e = solve::diagnostics(model, run.state).energies;
    const std::string title = std::string("block on a ") + (plane ? "plane" : "cylinder");
    verify(
        {"58", title, "time until it stands [s]", (2.0 - 1.0e-3) / (mu * g), stands, 1e-3, true, "(v0 - 0.001)/mu g"});
    verify({"58", title, "way until it stands [m]", 4.0 / (2.0 * mu * g), run.state.rigid[0].centre.x, 1e-3, true,
            "v0^2/2 mu g"});
    verify({"58", title, "force while it slides [N]", -mu * block_mass * g, force / sliding, 1e-3, true, "mu m g"});
    verify({"58", title, "dissipated / kinetic energy", 1.0, e.friction / (0.5 * block_mass * 4.0), 1e-3, true, "all"});
    verify({"58", title, "energy error at any time", 0.0, open, 1e-3, false, "balance"});
  }
}

TEST(friction_of_walls, holds_a_block_below_the_angle_of_friction_and_lets_it_slide_above) {
  for (const double slope : {16.0, 18.0}) {  // The angle of friction is 16.699 degrees.
    const double a = slope * pi / 180.0;
    auto d = block_on_a_wall({g * std::sin(a), 0.0, -g * std::cos(a)});
    d.planes.push_back({rubbing_wall(), {}, {0.0, 0.0, 1.0}});
    const bool holds = slope < 16.699;
    if (holds) {
      d.curves.push_back({"slowly", {{0.0, 0.0}, {2.0, 1.0}}, {}});
      d.gravity[0].curve = "slowly";
      d.bodies[0].translate.z = 0.005;
    } else {
      d.bodies[0].velocity = {0.5, 0.0, 0.0};
    }
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    run.advance(block_step, holds ? 22000 : 5000);
    double way = run.state.rigid[0].centre.x;
    if (holds) {  // It goes on swinging a little on the springs that hold it, which nothing damps.
      way = 0.0;
      for (int i = 0; i < 8000; ++i) {
        run.advance(block_step, 1);
        way += run.state.rigid[0].centre.x / 8000.0;
      }
    }
    if (holds) {
      verify({"59", "block on a slope of 16 degrees", "way, all of it elastic [m]",
              block_mass * g * std::sin(a) / (4.0 * wall_stiffness), way, 1e-3, true, "m g sin a/4 k"});
    } else {
      verify({"59", "block on a slope of 18 degrees", "way in 0.5 s [m]",
              0.25 + 0.125 * g * (std::sin(a) - mu * std::cos(a)), way, 1e-3, true, "g (sin a - mu cos a)"});
    }
  }
}

TEST(friction_of_walls, that_move_drags_a_plate_along) {
  for (const bool rigid : {false, true}) {
    auto d = block_on_a_wall({0.0, 0.0, -g});
    d.bodies[0].rigid = rigid;
    d.planes.push_back({rubbing_wall(), {}, {0.0, 0.0, 1.0}});
    const double speed = 1.5, duration = 0.8, dt = rigid ? block_step : 0.5 * block_step;
    d.planes[0].velocity = {speed, 0.0, 0.0};
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    // It takes 0.51 s to go along, and then swings a little on the springs that hold it.
    run.advance(dt, rigid ? 6000 : 12000);
    double way = 0.0, work = 0.0;
    const int steps = rigid ? 2000 : 4000;
    for (int i = 0; i < steps; ++i) {
      run.advance(dt, 1);
      work += solve::diagnostics(model, run.state).energies.external / steps;
    }
    for (Index n = 0; n < model.node_count(); ++n) {
      way += (run.state.motion[at(n)].position.x - model.reference_position[at(n)].x) / model.node_count();
    }
    const solve::Energies e = solve::diagnostics(model, run.state).energies;
    const std::string title = std::string(rigid ? "rigid" : "elastic") + " plate on a moving plane";
    verify({"60", title, "way [m]", speed * duration - speed * speed / (2.0 * mu * g), way, 1e-3, true,
            "V t - V^2/2 mu g"});
    verify({"60", title, "work of the wall [J]", block_mass * speed * speed, work, 2e-3, true, "m V^2"});
    verify({"60", title, "dissipated [J]", 0.5 * block_mass * speed * speed, e.friction, 2e-3, true, "m V^2/2"});
  }
}

}  // namespace
}  // namespace fexp
