// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cluster/simulation.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using test::verify;

using test::steel;

model::Plate plate(double lx, double ly, int nx, int ny, const char* diagonals = "one") {
  model::Plate p;
  p.length_x = lx;
  p.length_y = ly;
  p.cells_x = nx;
  p.cells_y = ny;
  p.diagonals = diagonals;
  return p;
}

TEST(spinning_plate, keeps_its_energy_and_angular_momentum_over_ten_turns) {
  for (const auto& [name, axis] :
       {std::pair{"z", Vec3d{0, 0, 1}}, std::pair{"x", Vec3d{1, 0, 0}}, std::pair{"skew", Vec3d{0.48, 0.6, 0.64}}}) {
    auto d = test::description(steel, 0.001);
    test::add_body(d, "plate", plate(0.1, 0.1, 8, 8)).angular_velocity = 1000.0 * axis;
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    const double end = 10.0 * 2.0 * std::numbers::pi / 1000.0;
    const double start_energy = simulation.start().energies.kinetic;
    double least = 1.0;
    while (simulation.state().time < end) {
      const auto report = simulation.run_epoch(end);
      ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
      least = std::min(least, report.diagnostics.energies.kinetic / start_energy);
    }
    const std::string title = std::string("spinning plate about ") + name;
    verify({"6", title, "least kinetic energy / first", 1.0, least, 1.5e-4, true, "independent code: >= 0.99985"});
    verify({"6", title, "angular momentum error", 0.0, simulation.extremes().angular_momentum_error, 1e-12, false,
            "exact"});
  }
}

TEST(elastic_cap, runs_back_to_its_start_when_velocities_are_reversed) {
  auto d = test::description({2.45e-4, 10.5e6, 0.3}, 0.41);
  test::add_body(d, "cap", plate(14.0, 14.0, 12, 12));
  d.pressure.push_back({{"cap"}, "", 600.0, "", {}});
  model::NodeSet rim;
  rim.name = "rim";
  rim.boundary = true;
  d.node_sets.push_back(rim);
  test::fix(d, "rim", {"x", "y", "z", "rx", "ry", "rz"});
  std::vector<model::Mesh> meshes{model::generate_mesh(plate(14.0, 14.0, 12, 12))};
  for (Vec3d& x : meshes[0].position) {
    const double a = x.x - 7.0, b = x.y - 7.0;
    x.z = std::sqrt(22.27 * 22.27 - a * a - b * b);
  }
  ErrorList errors;
  const model::Model model = model::build_model(d, meshes, errors);
  ASSERT_TRUE(errors.empty());
  test::DirectRun run(model);
  const double dt = 0.9 * model.first_critical_step;
  double excursion = 0.0;
  for (int i = 0; i < 20; ++i) {
    run.advance(dt, 100);
    for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
      excursion = std::max(excursion, norm(run.state.motion[n].position - model.reference_position[n]));
    }
  }
  for (model::NodeMotion& motion : run.state.motion) {
    motion.velocity = -motion.velocity;
    motion.rotation_rate = -motion.rotation_rate;
  }
  run.advance(dt, 2000);
  double miss = 0.0;
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    miss = std::max(miss, norm(run.state.motion[n].position - model.reference_position[n]));
  }
  EXPECT_GT(excursion, 0.01);
  verify({"7", "time reversal of a cap", "miss / excursion, 2000 steps", 0.0, miss / excursion, 1e-9, false,
          "reversibility"});
}

/// One free triangle on a rigid plane under gravity: three equal masses on three equal springs.
model::Model mass_on_spring(double courant, double step_ratio, double& dt) {
  model::Plate p = plate(0.1, 0.1, 1, 1);
  auto d = test::description({1000.0, 1.0e9, 0.0}, 0.01);
  d.gravity.push_back({{0, 0, -10.0}, "", {}});
  test::add_body(d, "triangle", p);
  d.planes.push_back({{"floor", 1.0}, {}, {0, 0, 1}});
  std::vector<model::Mesh> meshes{model::generate_mesh(p)};
  meshes[0].triangle.resize(1);
  meshes[0].part.resize(1);
  meshes[0].position.resize(3);
  ErrorList errors;
  meshes[0].triangle[0] = {0, 1, 2};
  model::Model model = model::build_model(d, meshes, errors);
  EXPECT_TRUE(errors.empty());
  dt = step_ratio * model.first_critical_step;
  model.walls[0].stiffness = model.mass[0] * (courant / dt) * (courant / dt);
  const double offset = model.mass[0] * 10.0 / model.walls[0].stiffness;
  for (Vec3d& x : model.reference_position) {
    x.z = model.half_thickness[0] - offset;
  }
  return model;
}

TEST(central_differences, have_their_known_period_and_growth) {
  for (const double courant : {0.1, 0.5, 1.0}) {
    double dt = 0.0;
    model::Model model = mass_on_spring(courant, 0.1, dt);
    const double rest = model.reference_position[0].z;
    const double offset = model.half_thickness[0] - rest;
    for (Vec3d& v : model.initial_velocity) {
      v.z = 0.1 * offset * courant / dt;
    }
    test::DirectRun run(model);
    // The discrete solution satisfies x(n+1) + x(n-1) = 2 cos(phase) x(n).
    double before = 0.0, now = 0.0, phase = 0.0, largest = 0.0;
    for (int i = 0; i < 200; ++i) {
      run.advance(dt, 1);
      const double next = run.state.motion[0].position.z - rest;
      if (std::abs(now) > largest) {
        largest = std::abs(now);
        phase = std::acos(0.5 * (next + before) / now);
      }
      before = now;
      now = next;
    }
    verify({"8", "mass and spring", fmt::format("T_h/T at omega dt = {}", courant),
            0.5 * courant / std::asin(0.5 * courant), courant / phase, 1e-6, true, "closed form"});
  }
}

TEST(central_differences, grow_as_known_beyond_their_limit) {
  double dt = 0.0;
  model::Model model = mass_on_spring(2.001, 0.02, dt);
  // Gravity that presses the spring in by a quarter of the half thickness: what grows stays in contact and, from the
  // first step on, far above the rounding of positions.
  const double offset = 0.25 * model.half_thickness[0];
  const double rest = model.half_thickness[0] - offset;
  model.gravity[0].acceleration.z = -(2.001 / dt) * (2.001 / dt) * offset;
  for (std::size_t n = 0; n < 3; ++n) {
    model.reference_position[n].z = rest;
    model.initial_velocity[n].z = 1e-5 * offset / dt;
  }
  test::DirectRun run(model);
  run.advance(dt, 99);
  const double before = run.state.motion[0].position.z - rest;
  run.advance(dt, 1);
  verify({"8", "mass and spring", "growth a step at omega dt = 2.001", 1.065286,
          std::abs((run.state.motion[0].position.z - rest) / before), 1e-6, true, "closed form"});
}

double energy_growth(const model::Model& model, double dt) {
  test::DirectRun run(model);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-6, 1e-6);
  double start = 0.0, end = 0.0;
  for (model::NodeMotion& motion : run.state.motion) {
    motion.velocity = {noise(random), noise(random), 0.0};
    start += dot(motion.velocity, motion.velocity);
  }
  run.advance(dt, 2000);
  for (const model::NodeMotion& motion : run.state.motion) {
    end += dot(motion.velocity, motion.velocity);
  }
  return end / start;
}

TEST(stable_step, of_a_sheet_of_right_triangles_is_as_known) {
  // In-plane motion only: the limit is the membrane's, sqrt(1/2) leg / c.
  auto d = test::description({1.0, 1.0, 0.0}, 0.01);
  d.run.drilling = 0.0;
  test::add_body(d, "sheet", plate(12.0, 12.0, 12, 12));
  const model::Model model = test::build(d);
  const double limit = std::sqrt(0.5);
  EXPECT_LT(energy_growth(model, 0.95 * limit), 10.0);
  const double growth = energy_growth(model, 1.05 * limit);
  EXPECT_FALSE(growth < 1e6) << growth;  // also true when the numbers have overflowed
}

TEST(penalty_bounce, keeps_its_energy_within_the_known_band) {
  for (const auto& [courant, band] : {std::pair{0.05, 4e-4}, std::pair{0.2, 9e-3}, std::pair{0.5, 4.5e-2}}) {
    double worst = 0.0;
    // The moment of touching falls anywhere within a step.
    for (const double phase : {0.0, 0.13, 0.29, 0.5, 0.71, 0.93}) {
      double dt = 0.0;
      model::Model model = mass_on_spring(courant, 0.1, dt);
      model.gravity.clear();
      const double speed = 0.01;
      for (std::size_t n = 0; n < 3; ++n) {
        model.reference_position[n].z = model.half_thickness[n] + speed * dt * (0.5 + phase);
        model.initial_velocity[n] = {0, 0, -speed};
      }
      test::DirectRun run(model);
      run.advance(dt, static_cast<Index>(4.0 * std::numbers::pi / courant));
      const double out = run.state.motion[0].velocity.z / speed;
      worst = std::max(worst, std::abs(out * out - 1.0));
    }
    verify({"27", "penalty bounce", fmt::format("kinetic energy out/in at omega dt = {}", courant), 1.0, 1.0 + worst,
            band, true, "closed form band"});
  }
}

TEST(gravity, rest_and_drop_on_a_plane_are_as_known) {
  // Three nodes share 2 kg and 1e5 N/m.
  double dt = 0.0;
  model::Model model = mass_on_spring(0.1, 0.1, dt);
  const double gravity = 9.81;
  model.gravity[0].acceleration.z = -gravity;
  for (std::size_t n = 0; n < 3; ++n) {
    model.mass[n] = 2.0 / 3.0;
    model.inertia[n] *= 2.0 / 3.0 / 0.0333333;
    model.reference_position[n].z = model.half_thickness[n];
  }
  model.walls[0].stiffness = 1.0e5 / 3.0;
  dt = 1.0e-5;
  model.run.damping = 400.0;
  test::DirectRun rest(model);
  rest.advance(dt, 20000);
  verify({"28", "gravity rest", "penetration", 1.962e-4, model.half_thickness[0] - rest.state.motion[0].position.z,
          1e-6, true, "M g / (n k)"});

  model.run.damping = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    model.reference_position[n].z = model.half_thickness[n] + 0.05;
  }
  test::DirectRun drop(model);
  double deepest = 0.0, force = 0.0, touching = 0.0;
  for (int i = 0; i < 13000; ++i) {
    drop.advance(dt, 1);
    const double depth = model.half_thickness[0] - drop.state.motion[0].position.z;
    deepest = std::max(deepest, depth);
    force = std::max(force, drop.workspace.actions[0].wall_force[0].z);
    touching += depth > 0.0 ? dt : 0.0;
  }
  verify({"28", "drop of 50 mm", "deepest penetration", 4.62999e-3, deepest, 0.01, true, "closed form"});
  verify({"28", "drop of 50 mm", "largest force", 463.0, force, 0.01, true, "closed form"});
  verify({"28", "drop of 50 mm", "contact time", 14.4456e-3, touching, 0.01, true, "closed form"});
}

/// Displacements of a twisted, bent plate after some smooth motion, turned back into the original axes.
std::vector<Vec3d> smooth_motion(const model::Rotation& turn, const Vec3d& shift, bool renumber) {
  auto d = test::description(steel, 0.002);
  model::BodyDescription& body = test::add_body(d, "plate", plate(0.1, 0.06, 6, 4));
  body.rotate.push_back(turn);
  body.translate = shift;
  std::vector<model::Mesh> meshes{model::generate_mesh(plate(0.1, 0.06, 6, 4))};
  std::vector<Index> position_of(meshes[0].position.size());
  std::iota(position_of.begin(), position_of.end(), 0);
  if (renumber) {
    std::shuffle(position_of.begin(), position_of.end(), std::mt19937(3));
    model::Mesh shuffled = meshes[0];
    for (std::size_t n = 0; n < position_of.size(); ++n) {
      shuffled.position[at(position_of[n])] = meshes[0].position[n];
    }
    for (auto& t : shuffled.triangle) {
      t = {position_of[at(t[1])], position_of[at(t[2])], position_of[at(t[0])]};
    }
    std::reverse(shuffled.triangle.begin(), shuffled.triangle.end());
    meshes[0] = shuffled;
  }
  ErrorList errors;
  model::Model model = model::build_model(d, meshes, errors);
  EXPECT_TRUE(errors.empty());
  const double angle = turn.angle_degrees * std::numbers::pi / 180.0;
  const Vec3d axis = (1.0 / norm(turn.axis)) * turn.axis;
  const auto rotate = [&](const Vec3d& v, double a) {
    return std::cos(a) * v + std::sin(a) * cross(axis, v) + ((1.0 - std::cos(a)) * dot(axis, v)) * axis;
  };
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    const Vec3d x = rotate(model.reference_position[n] - shift, -angle);
    model.initial_velocity[n] = rotate({0.0, 0.0, 20.0 * std::sin(30.0 * x.x) * std::cos(40.0 * x.y)}, angle);
  }
  test::DirectRun run(model);
  run.advance(2.0e-7, 1000);
  std::vector<Vec3d> displacement(position_of.size());
  for (std::size_t n = 0; n < displacement.size(); ++n) {
    const std::size_t i = at(position_of[n]);
    displacement[n] = rotate(run.state.motion[i].position - model.reference_position[i], -angle);
  }
  return displacement;
}

TEST(invariance, under_renumbering_rotation_and_translation) {
  const model::Rotation none{{0, 0, 1}, 0.0, {}};
  const std::vector<Vec3d> original = smooth_motion(none, {}, false);
  double size = 0.0;
  for (const Vec3d& u : original) {
    size = std::max(size, norm(u));
  }
  const auto difference = [&](const std::vector<Vec3d>& other) {
    double largest = 0.0;
    for (std::size_t n = 0; n < original.size(); ++n) {
      largest = std::max(largest, norm(other[n] - original[n]));
    }
    return largest / size;
  };
  verify({"32", "invariance", "renumbered: change / displacement", 0, difference(smooth_motion(none, {}, true)), 1e-10,
          false, "exact"});
  verify({"32", "invariance", "rotated: change / displacement", 0,
          difference(smooth_motion({{0.3, -0.5, 0.8}, 77.0, {}}, {}, false)), 1e-10, false, "exact"});
  verify({"32", "invariance", "translated: change / displacement", 0,
          difference(smooth_motion(none, {0.5, -0.25, 0.125}, false)), 1e-10, false, "exact"});
}

}  // namespace
}  // namespace fexp
