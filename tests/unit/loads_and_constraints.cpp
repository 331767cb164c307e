// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "solve/diagnostics.hpp"
#include "solve/loads.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using test::rubber;

model::Plate plate(double side, int cells, const char* diagonals = "one") {
  model::Plate p;
  p.length_x = p.length_y = side;
  p.cells_x = p.cells_y = cells;
  p.diagonals = diagonals;
  return p;
}

model::CubedSphere sphere(double radius, int cells) {
  model::CubedSphere s;
  s.radius = radius;
  s.cells = cells;
  return s;
}

/// One body that moves and turns; the base of all descriptions here.
model::Description tumbling(const model::MeshGenerator& mesh) {
  auto d = test::description(rubber, 0.02);
  model::BodyDescription& body = test::add_body(d, "body", mesh);
  body.translate = {0.3, -0.2, 0.4};
  body.velocity = {0.5, 0.2, -0.3};
  body.angular_velocity = {1.0, -2.0, 1.5};
  d.curves.push_back({"ramp", {{0.0, 0.0}, {0.1, 1.0}, {0.2, -0.5}}, {}});
  return d;
}

/// Everything that acts on a body from outside, each alone and all at once.
std::vector<std::pair<std::string, std::function<void(model::Description&)>>> outside_actions() {
  const auto add_edges = [](model::Description& d) {
    if (d.node_sets.empty()) {
      test::add_box_set(d, "left", {0.29, -0.3, 0.3}, {0.31, 0.9, 0.5});
      test::add_box_set(d, "right", {1.29, -0.3, 0.3}, {1.31, 0.9, 0.5});
    }
  };
  std::vector<std::pair<std::string, std::function<void(model::Description&)>>> actions{
      {"nothing", [](model::Description&) {}},
      {"gravity",
       [](model::Description& d) {
         d.gravity.push_back({{1.0, -2.0, -9.81}, "ramp", {}});
       }},
      {"pressure",
       [](model::Description& d) {
         d.pressure.push_back({{"body"}, "", 50.0, "ramp", {}});
       }},
      {"forces",
       [=](model::Description& d) {
         add_edges(d);
         d.forces.push_back({"right", {1.0, 2.0, 3.0}, {0.1, 0.2, -0.1}, true, "ramp", {}});
       }},
      {"plane",
       [](model::Description& d) {
         d.planes.push_back({{"floor"}, {0.3, -0.2, 0.385}, {0.0, 0.6, 0.8}});
       }},
      {"damping", [](model::Description& d) { d.run.damping = 5.0; }},
      {"fixed",
       [=](model::Description& d) {
         add_edges(d);
         test::fix(d, "left", {"x", "z", "ry"});
       }},
      {"prescribed",
       [=](model::Description& d) {
         add_edges(d);
         d.prescribed.push_back({"right", "y", 0.8, "ramp", {}});
         d.prescribed.push_back({"right", "rx", 1.0, "ramp", {}});
       }},
      {"moved",
       [=](model::Description& d) {
         add_edges(d);
         model::Prescribed moved{"right", "z", {}, "ramp", {}};
         moved.displacement = 0.05;
         d.prescribed.push_back(moved);
         model::Prescribed accelerated{"right", "rz", {}, "ramp", {}};
         accelerated.acceleration = 8.0;
         d.prescribed.push_back(accelerated);
       }},
      {"oblique",
       [=](model::Description& d) {
         add_edges(d);
         const model::LocalAxes axes{{1.0, 2.0, -1.0}, {0.0, 1.0, 3.0}};
         d.fixed.push_back({"left", {"y", "rx"}, {}, axes});
         d.prescribed.push_back({"left", "x", 0.6, "ramp", {}});
         d.prescribed.back().axes = axes;
       }},
      {"masses",
       [=](model::Description& d) {
         add_edges(d);
         d.point_masses.push_back({"right", 8.0, 0.01, true, {}});
         d.run.minimum_step = 1.0e-4;
         d.gravity.push_back({{1.0, -2.0, -9.81}, "ramp", {}});
       }},
      {"symmetry",
       [=](model::Description& d) {
         add_edges(d);
         d.symmetry.push_back({"left", {0.0, 0.6, 0.8}, {}});
       }},
  };
  auto each = actions;
  actions.emplace_back("all", [each](model::Description& d) {
    for (const auto& [name, act] : each) {
      if (name != "symmetry" && name != "oblique") {
        act(d);
      }
    }
  });
  return actions;
}

/// Largest drift of the energy at the same instants for any step, after the checks that need no refinement.
double energy_error(const std::string& name, const std::function<void(model::Description&)>& act, double safety) {
  auto d = tumbling(plate(1.0, 4));
  d.run.safety = safety;
  d.run.epoch_steps = 10000;
  act(d);
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const double start = simulation.start().energies.balance();
  double drift = 0.0;
  for (int i = 1; i <= 25; ++i) {
    while (simulation.state().time < 0.01 * i) {
      const auto report = simulation.run_epoch(0.01 * i);
      EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << name << ": " << report.fault.message;
      drift = std::max(drift, std::abs(report.diagnostics.energies.balance() - start) / start);
    }
  }
  EXPECT_LT(simulation.extremes().linear_momentum_error, 1.0e-12) << name;
  EXPECT_LT(simulation.extremes().angular_momentum_error, 1.0e-12) << name;
  EXPECT_EQ(norm(simulation.state().ledger[0].external_impulse) > 0.0, name != "nothing");
  return drift;
}

TEST(outside_actions, balance_momenta_to_rounding_and_energy_to_the_square_of_the_step) {
  for (const auto& [name, act] : outside_actions()) {
    const double coarse = energy_error(name, act, 0.4), fine = energy_error(name, act, 0.1);
    EXPECT_LT(coarse, 5.0e-3) << name;
    EXPECT_LT(fine, coarse / 4.0) << name << ": a fourth of the step, at best a sixteenth of the error";
    std::printf("%-12s energy error %.2e, with a fourth of the step %.2e\n", name.c_str(), coarse, fine);
  }
}

TEST(gravity, gives_every_body_the_momentum_of_the_curve_under_its_integral) {
  auto d = tumbling(plate(1.0, 3));
  d.gravity.push_back({{0.0, 0.0, -10.0}, "ramp", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const Vec3d before = solve::diagnostics(model, run.state).momenta.linear;
  // 2000 steps with the curve's corner on a step: the half-step sums are then exact.
  const double dt = 0.1 / 1000.0;
  run.advance(dt, 2000);
  const Vec3d gained = solve::diagnostics(model, run.state).momenta.linear - before;
  const double integral = 0.05 + 0.1 * 0.25;
  const double mass = model.bodies[0].mass;
  EXPECT_NEAR(gained.z, -10.0 * mass * integral, 1e-10 * mass);
  EXPECT_NEAR(gained.x, 0.0, 1e-12 * mass);
  EXPECT_NEAR(run.state.ledger[0].external_impulse.z, gained.z, 1e-11 * mass);
}

/// Loads on body 0 at the positions of `state`.
std::vector<solve::NodalAction> loads(const model::Model& model, const model::State& state, double time) {
  std::vector<solve::NodalAction> load(model.reference_position.size());
  solve::evaluate_loads(model, state.motion.data(), state.layers.data(), true, time, 0, load.data());
  return load;
}

TEST(pressure, on_a_closed_surface_has_no_resultant_and_no_moment_whatever_its_shape) {
  auto d = tumbling(sphere(0.5, 3));
  d.pressure.push_back({{"body"}, "", 1.0e3, "", {}});
  const model::Model model = test::build(d);
  model::State state = model::initial_state(model);
  for (std::size_t n = 0; n < state.motion.size(); ++n) {
    Vec3d& x = state.motion[n].position;
    x = {x.x + 0.2 * std::sin(3.0 * x.y), 1.3 * x.y + 0.1 * x.z * x.z, x.z + 0.2 * x.x * x.y};
  }
  Vec3d force, moment;
  double sum = 0.0;
  const auto load = loads(model, state, 0.0);
  for (std::size_t n = 0; n < load.size(); ++n) {
    force += load[n].force;
    moment += cross(state.motion[n].position, load[n].force);
    sum += norm(load[n].force);
  }
  EXPECT_GT(sum, 1.0e3);
  EXPECT_LT(norm(force), 1e-13 * sum);
  // Corner forces of a third each act in the centroid, where the pressure on a flat triangle does.
  EXPECT_LT(norm(moment), 1e-13 * sum);
}

TEST(pressure, on_an_open_surface_is_the_area_times_the_value_against_the_normal) {
  auto d = tumbling(plate(2.0, 3));
  d.bodies[0].rotate.push_back({{1.0, 0.0, 0.0}, 90.0, {}});  // the normal +z becomes -y
  d.pressure.push_back({{"body"}, "", 7.0, "ramp", {}});
  const model::Model model = test::build(d);
  const model::State state = model::initial_state(model);
  for (const auto& [time, factor] : {std::pair{0.0, 0.0}, std::pair{0.05, 0.5}, std::pair{0.3, -0.5}}) {
    Vec3d force;
    for (const solve::NodalAction& action : loads(model, state, time)) {
      force += action.force;
    }
    EXPECT_LT(norm(force - Vec3d{0.0, 28.0 * factor, 0.0}), 1e-12) << time;
  }
}

double enclosed_volume(const model::Model& model, const model::State& state) {
  double volume = 0.0;
  for (const auto& t : model.triangle) {
    volume +=
        dot(state.motion[at(t[0])].position, cross(state.motion[at(t[1])].position, state.motion[at(t[2])].position)) /
        6.0;
  }
  return volume;
}

TEST(pressure, does_the_work_of_the_volume_it_takes_away) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "ball", sphere(0.5, 4));
  d.pressure.push_back({{"ball"}, "", 2000.0, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double before = enclosed_volume(model, run.state);
  run.advance(0.2 * model.first_critical_step, 400);
  const double after = enclosed_volume(model, run.state);
  ASSERT_LT(after, 0.99 * before);
  EXPECT_NEAR(run.state.ledger[0].external_work, 2000.0 * (before - after), 1e-5 * 2000.0 * (before - after));
}

TEST(prescribed_motion, of_a_whole_body_puts_in_its_kinetic_energy_and_momentum) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "body", plate(1.0, 3));
  d.curves.push_back({"start", {{0.0, 0.0}, {0.1, 1.0}}, {}});
  d.prescribed.push_back({"all", "x", 3.0, "start", {}});
  d.prescribed.push_back({"all", "z", -4.0, "start", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  run.advance(0.1 / 500.0, 700);
  const double mass = model.bodies[0].mass;
  for (const model::NodeMotion& motion : run.state.motion) {
    EXPECT_EQ(motion.velocity, (Vec3d{3.0, 0.0, -4.0}));
  }
  EXPECT_NEAR(run.state.ledger[0].external_work, 0.5 * mass * 25.0, 1e-11 * mass);
  EXPECT_NEAR(run.state.ledger[0].external_impulse.x, 3.0 * mass, 1e-11 * mass);
  EXPECT_NEAR(run.state.ledger[0].external_impulse.z, -4.0 * mass, 1e-11 * mass);
}

TEST(prescribed_motion, of_one_edge_strains_the_body_by_the_work_it_does) {
  // A strip is pulled apart so slowly that all work becomes strain energy: 1/2 E A e^2 L, with free sides.
  auto d = test::description({1000.0, 1.0e6, 0.0}, 0.02);
  test::add_body(d, "strip", plate(1.0, 4));
  test::add_box_set(d, "left", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  test::add_box_set(d, "right", {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0});
  test::fix(d, "left", {"x"});
  d.curves.push_back({"slow", {{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}}, {}});
  d.prescribed.push_back({"right", "x", 0.001, "slow", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double dt = 0.5 * model.first_critical_step;
  run.advance(2.0 / std::ceil(2.0 / dt), static_cast<Index>(std::ceil(2.0 / dt)));
  const double exact = 0.5 * 1.0e6 * 0.02 * 0.001 * 0.001;
  const solve::Energies e = solve::diagnostics(model, run.state).energies;
  EXPECT_NEAR(e.external, exact, 5e-3 * exact);
  EXPECT_NEAR(e.internal, exact, 5e-3 * exact);
}

TEST(damping, of_steady_flight_loses_the_exact_factor_and_books_the_lost_energy) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "body", plate(1.0, 3)).velocity = {3.0, 0.0, 4.0};
  d.run.damping = 12.0;
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double dt = 1.0e-3, mass = model.bodies[0].mass;
  run.advance(dt, 50);
  const double factor = std::pow(1.0 + 0.5 * 12.0 * dt, -100.0);
  EXPECT_NEAR(factor, std::exp(-12.0 * 0.05), 1e-2);
  for (const model::NodeMotion& motion : run.state.motion) {
    EXPECT_LT(norm(motion.velocity - factor * Vec3d{3.0, 0.0, 4.0}), 1e-12);
  }
  EXPECT_NEAR(run.state.ledger[0].damping_work, 0.5 * mass * 25.0 * (1.0 - factor * factor), 1e-11 * mass);
  EXPECT_NEAR(run.state.ledger[0].external_impulse.z, 4.0 * mass * (factor - 1.0), 1e-11 * mass);
}

TEST(symmetry, half_a_body_moves_as_half_of_the_whole) {
  // Velocities and rotation rates that are mirror images of each other across x = 1.
  const auto run_plate = [](bool half) {
    auto d = test::description(rubber, 0.05);
    model::Plate mesh = plate(2.0, 8, "crossed");
    if (half) {
      mesh.length_x = 1.0;
      mesh.cells_x = 4;
    }
    test::add_body(d, "plate", mesh);
    if (half) {
      test::add_box_set(d, "middle", {1.0, 0.0, 0.0}, {1.0, 2.0, 0.0});
      d.symmetry.push_back({"middle", {1.0, 0.0, 0.0}, {}});
    }
    model::Model model = test::build(d);
    for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
      const Vec3d& x = model.reference_position[n];
      const double bow = x.x * (2.0 - x.x);
      model.initial_velocity[n] = {0.3 * (x.x - 1.0), 0.2 * bow * x.y, 2.0 * bow * std::cos(x.y)};
    }
    test::DirectRun run(model);
    run.advance(0.5 * model.first_critical_step, 300);
    std::vector<std::pair<Vec3d, Vec3d>> ends;
    for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
      if (model.reference_position[n].x < 1.0 + 1e-9) {
        ends.emplace_back(model.reference_position[n], run.state.motion[n].position);
      }
    }
    return ends;
  };
  const auto half = run_plate(true), whole = run_plate(false);
  ASSERT_EQ(half.size(), whole.size());
  double moved = 0.0;
  for (const auto& [start, end] : half) {
    const auto twin = std::find_if(whole.begin(), whole.end(),
                                   [&, from = start](const auto& other) { return norm(other.first - from) < 1e-12; });
    ASSERT_NE(twin, whole.end());
    EXPECT_LT(norm(twin->second - end), 1e-9);
    moved = std::max(moved, norm(end - start));
  }
  EXPECT_GT(moved, 0.01);
}

double sudden_energy(const model::Model& model) {
  return solve::sudden_load_energy(model, model::initial_state(model), 0.1);
}

TEST(sudden_load_energy, is_an_eighth_of_the_squares_that_a_step_gives_free_nodes) {
  model::Description d = tumbling(plate(1.0, 2));
  EXPECT_EQ(sudden_energy(test::build(d)), 0.0);
  d.gravity.push_back({{3.0, 0.0, -4.0}, "", {}});
  const model::Model heavy = test::build(d);
  EXPECT_NEAR(sudden_energy(heavy), 0.01 * 25.0 * heavy.bodies[0].mass / 8.0, 1e-12);
  d.gravity.back().curve = "ramp";  // From nothing
  EXPECT_EQ(sudden_energy(test::build(d)), 0.0);
}

/// A pull at the end of a resting strip, in whose first steps next to no energy is there yet; and a strip that takes
/// too large steps, whose balance the watchdog must not put down to the load.
TEST(sudden_load_energy, keeps_the_watchdog_from_sound_runs_alone) {
  for (const bool sound : {true, false}) {
    model::Description d = test::description(rubber, 0.1);
    model::Plate strip = plate(1.0, 1);
    strip.length_x = 10.0;
    strip.cells_x = 20;
    test::add_body(d, "strip", strip);
    test::add_box_set(d, "end", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
    d.forces.push_back({"end", {-100.0, 0.0, 0.0}, {}, true, "", {}});
    model::Model model = test::build(d);
    if (!sound) {
      for (double& mass : model.mass) {
        mass *= 0.2;
      }
    }
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    bool stopped = false;
    const double step = model.run.safety * model.first_critical_step;
    for (int i = 1; i <= 40 && !stopped; ++i) {
      stopped = simulation.run_epoch(i * step).fault.kind != cluster::FaultKind::none;
    }
    EXPECT_EQ(stopped, !sound);
  }
}

}  // namespace
}  // namespace fexp
