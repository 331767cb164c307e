// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cluster/simulation.hpp"
#include "cluster/wall_reach.hpp"
#include "model/body_properties.hpp"
#include "model/build_walls.hpp"
#include "solve/diagnostics.hpp"
#include "solve/wall_penetrations.hpp"
#include "solve/walls.hpp"
#include "support/models.hpp"

namespace fexp::walls_with_mass {
namespace {

using model::Description;
using model::RigidPlane;
using model::RigidSphere;
using model::Wall;
using model::WallShape;

/// A plate of 1 x 1 in the plane z = 0, without contact.
Description plate() {
  Description d = test::description(test::rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 4, 4, "one"});
  return d;
}

RigidSphere& add_sphere(Description& d, const char* name, const Vec3d& centre, double mass) {
  RigidSphere& sphere = d.spheres.emplace_back();
  sphere.name = name;
  sphere.centre = centre;
  sphere.radius = 0.2;
  sphere.mass = mass;
  return sphere;
}

RigidPlane& add_plane(Description& d, const char* name, double z, double normal, double mass) {
  RigidPlane& plane = d.planes.emplace_back();
  plane.name = name;
  plane.point = {0.0, 0.0, z};
  plane.normal = {0.0, 0.0, normal};
  plane.mass = mass;
  return plane;
}

cluster::EpochReport run(cluster::Simulation& simulation, double duration) {
  cluster::EpochReport report;
  while (simulation.state().time < duration && report.fault.kind == cluster::FaultKind::none) {
    report = simulation.run_epoch(duration);
  }
  return report;
}

const model::NodeMotion& motion_of(const model::Model& model, const model::State& state, std::size_t wall) {
  return state.motion[at(model.bodies[at(model.walls[wall].body)].nodes.begin)];
}

TEST(walls_with_mass, are_bodies_of_one_node_after_all_others) {
  Description d = plate();
  RigidSphere& ball = add_sphere(d, "ball", {1.0, 2.0, 3.0}, 4.0);
  ball.initial_velocity = {1.0, -1.0, 0.5};
  ball.force = {0.0, 7.0, 0.0};
  add_plane(d, "table", -1.0, 1.0, -1.0);
  const model::Model model = test::build(d);
  ASSERT_EQ(model.body_count(), 2);
  EXPECT_EQ(model.meshed_body_count(), 1);
  EXPECT_EQ(model.walls[0].body, no_index);
  EXPECT_EQ(model.walls[0].inverse_mass, 0.0);
  EXPECT_EQ(model.walls[1].body, 1);
  EXPECT_EQ(model.walls[1].inverse_mass, 0.25);
  EXPECT_EQ(model.walls[1].span, 1.0);
  const model::Body& body = model.bodies[1];
  EXPECT_EQ(body.name, "ball");
  EXPECT_EQ(body.wall, 1);
  EXPECT_FALSE(body.barrier);
  EXPECT_EQ(body.elements.size(), 0);
  ASSERT_EQ(body.nodes, (IndexRange{25, 26}));
  EXPECT_EQ(model.mass[25], 4.0);
  EXPECT_EQ(test::nodes_of(model, "all").size(), 25U);
  const model::State state = model::initial_state(model);
  EXPECT_EQ(state.motion[25].position, (Vec3d{1.0, 2.0, 3.0}));
  EXPECT_EQ(state.motion[25].velocity, (Vec3d{1.0, -1.0, 0.5}));
  ASSERT_EQ(body.forces.size(), 1);
  EXPECT_EQ(model.forces[at(body.forces.begin)].force, (Vec3d{0.0, 7.0, 0.0}));
  const model::BodyProperties p = model::body_properties(model, 1);
  EXPECT_EQ(p.mass, 4.0);
  EXPECT_EQ(p.centre, (Vec3d{1.0, 2.0, 3.0}));
}

TEST(walls_with_mass, are_free_along_the_normal_across_the_axis_or_as_told) {
  const auto is_held = [](const std::vector<Vec3d>& held, const Vec3d& direction) {
    double part = 0.0;
    for (const Vec3d& h : held) {
      EXPECT_NEAR(norm(h), 1.0, 1e-15);
      part += dot(h, direction) * dot(h, direction);
    }
    return part / dot(direction, direction);
  };
  model::RigidWall wall;
  for (const Vec3d& n : {Vec3d{0.0, 0.0, 2.0}, Vec3d{1.0, -2.0, 0.3}, Vec3d{1.0, 1.0, 1.0}, Vec3d{-1.0, 0.0, 0.0}}) {
    std::vector<Vec3d> held = model::held_directions(wall, WallShape::plane, n);
    EXPECT_EQ(held.size(), 2U);
    EXPECT_NEAR(is_held(held, n), 0.0, 1e-30);
    held = model::held_directions(wall, WallShape::cylinder, n);
    EXPECT_EQ(held.size(), 1U);
    EXPECT_NEAR(is_held(held, n), 1.0, 1e-15);
  }
  EXPECT_TRUE(model::held_directions(wall, WallShape::sphere, {}).empty());
  wall.free = {"z", "x"};
  EXPECT_EQ(model::held_directions(wall, WallShape::plane, {1.0, 1.0, 1.0}), (std::vector<Vec3d>{{0.0, 1.0, 0.0}}));
  wall.free.reset();
  wall.guide = {3.0, 0.0, 4.0};
  EXPECT_NEAR(is_held(model::held_directions(wall, WallShape::sphere, {}), {3.0, 0.0, 4.0}), 0.0, 1e-30);
  EXPECT_NEAR(is_held(model::held_directions(wall, WallShape::sphere, {}), {4.0, 0.0, -3.0}), 1.0, 1e-15);
}

/// The largest eigenvalue of diag(k_i/m_i) + a a^T/M by iteration from above its second one.
double largest_eigenvalue(const std::vector<double>& k, const std::vector<double>& m, double wall) {
  std::vector<double> v(k.size(), 1.0);
  double value = 0.0;
  for (int i = 0; i < 20000; ++i) {
    double shared = 0.0, length2 = 0.0;
    for (std::size_t j = 0; j < k.size(); ++j) {
      shared += std::sqrt(k[j]) * v[j] / wall;
    }
    for (std::size_t j = 0; j < k.size(); ++j) {
      v[j] = k[j] / m[j] * v[j] + std::sqrt(k[j]) * shared;
      length2 += v[j] * v[j];
    }
    value = std::sqrt(length2);
    for (double& x : v) {
      x /= value;
    }
  }
  return value;
}

TEST(walls_with_mass, bound_the_frequency_of_all_nodes_that_they_join) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0.1, 3.0);
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t count = 1 + static_cast<std::size_t>(trial) % 5;
    std::vector<double> k(count), m(count);
    double nodes2 = 0.0;
    solve::WallTouch touch;
    for (std::size_t i = 0; i < count; ++i) {
      k[i] = number(random);
      m[i] = number(random);
      nodes2 = std::max(nodes2, k[i] / m[i]);
      touch.stiffness += k[i];
    }
    const double wall = number(random) * (trial % 3 == 0 ? 0.01 : 1.0);
    const double bound = solve::joined_frequency2(nodes2, touch, 1.0 / wall), exact = largest_eigenvalue(k, m, wall);
    EXPECT_GE(bound, exact * (1.0 - 1e-9));
    EXPECT_LE(bound, 2.0 * exact);
    if (count == 1) {
      EXPECT_NEAR(bound, exact, 1e-9 * exact);
    }
  }
}

/// Nodes that a light wall joins, with the damping of the step before as the solver has it: at the bound energy does
/// not grow, although the wall's own frequency is far above that of each pair.
TEST(walls_with_mass, bound_the_step_where_there_is_damping) {
  constexpr int count = 20;
  constexpr double k = 1.0, m = 1.0, part = 0.7;
  for (const double wall : {0.01, 0.3, 20.0}) {
    const double inverse = 1.0 / m + 1.0 / wall, c = 2.0 * part * std::sqrt(k / inverse);
    const double root = part + std::sqrt(1.0 + part * part);
    const solve::WallTouch touch{count * k, count * c};
    const double dt = 2.0 / std::sqrt(solve::joined_frequency2(root * root * k / m, touch, 1.0 / wall));
    std::vector<double> x(count, 0.0), v(count, 0.0);
    double y = 0.0, u = 1.0, largest = 0.0;
    for (int i = 0; i < count; ++i) {
      v[static_cast<std::size_t>(i)] = 0.01 * i;
    }
    for (int step = 0; step < 20000; ++step) {
      double push = 0.0;
      std::vector<double> force(count);
      for (std::size_t i = 0; i < count; ++i) {
        force[i] = k * (y - x[i]) + c * (u - v[i]);
        push -= force[i];
      }
      for (std::size_t i = 0; i < count; ++i) {
        v[i] += dt * force[i] / m;
        x[i] += dt * v[i];
      }
      u += dt * push / wall;
      y += dt * u;
      largest = std::max(largest, std::abs(u));
    }
    EXPECT_LE(largest, 2.0) << wall;
  }
}

/// Where a wall with mass, a plane or round, comes against a plate that is free: what one loses the other gains.
TEST(walls_with_mass, keep_momentum_and_energy_with_the_bodies_that_they_push) {
  for (const bool rubs : {false, true}) {
    Description d = plate();
    d.contact.friction = rubs ? 0.3 : 0.0;
    d.contact.damping = rubs ? 0.2 : 0.0;
    add_sphere(d, "ball", {0.4, 0.45, 0.22}, 3.0).initial_velocity = {0.5, 0.2, -2.0};
    add_plane(d, "table", -0.02, 1.0, 5.0).free = {"x", "y", "z"};
    const model::Model model = test::build(d);
    test::DirectRun direct(model);
    const solve::Diagnostics start = solve::diagnostics(model, direct.state);
    const double dt = 0.1 * model.first_critical_step;
    double open = 0.0, least = start.energies.kinetic;
    for (int i = 0; i < 400; ++i) {
      direct.advance(dt, 5);
      const solve::Diagnostics now = solve::diagnostics(model, direct.state);
      open = std::max(open, std::abs(now.energies.balance() - start.energies.balance()));
      least = std::min(least, now.energies.kinetic);
    }
    const solve::Diagnostics end = solve::diagnostics(model, direct.state);
    EXPECT_LT(least, 0.9 * start.energies.kinetic) << "nothing happened";
    EXPECT_LT(open, 5.0e-3 * start.energies.kinetic) << rubs;
    EXPECT_NEAR(norm(end.momenta.linear - start.momenta.linear), 0.0, 1e-12 * start.momenta.linear_scale);
    EXPECT_NEAR(norm(end.momenta.external_impulse), 0.0, 1e-12 * start.momenta.linear_scale);
    EXPECT_NEAR(end.energies.external, 0.0, 1e-10 * start.energies.kinetic) << "walls give what they take";
    EXPECT_EQ(end.energies.friction > 0.0, rubs);
    EXPECT_LT(motion_of(model, direct.state, 0).velocity.z, -0.1) << "the table was not pushed";
    EXPECT_EQ(motion_of(model, direct.state, 0).velocity.x != 0.0, rubs) << "friction alone drags the table along";
  }
}

TEST(walls_with_mass, fall_by_their_weight_and_their_force) {
  Description d = plate();
  d.gravity.push_back({{0.0, 0.0, -10.0}, "", {}});
  d.curves.push_back({"off", {{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}}, {}});
  d.run.duration = 0.1;
  RigidSphere& ball = add_sphere(d, "ball", {5.0, 5.0, 3.0}, 2.0);
  ball.force = {6.0, 0.0, 0.0};
  ball.curve = "off";
  RigidPlane& sled = add_plane(d, "sled", -70.0, 1.0, 2.0);
  sled.guide = {3.0, 0.0, 4.0};
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const cluster::EpochReport report = run(simulation, 0.1);
  ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  EXPECT_LT(report.energy_error, 1e-6);
  const Vec3d velocity = motion_of(model, simulation.state(), 1).velocity;
  EXPECT_NEAR(velocity.x, 0.3, 1e-12);
  EXPECT_EQ(velocity.y, 0.0);
  EXPECT_NEAR(velocity.z, -1.0, 1e-12);
  const Vec3d guided = motion_of(model, simulation.state(), 0).velocity;
  EXPECT_NEAR(guided.x, -0.48, 1e-12);
  EXPECT_EQ(guided.y, 0.0);
  EXPECT_NEAR(guided.z, -0.64, 1e-12);
}

TEST(walls_with_mass, that_are_light_make_the_step_smaller_and_stay_stable) {
  const auto smallest_step = [](double mass) {
    Description d = plate();
    d.contact.damping = 0.3;
    add_plane(d, "lid", 0.0101, -1.0, mass).initial_velocity = {0.0, 0.0, -0.5};
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    cluster::EpochReport report;
    double largest = 0.0;
    while (simulation.state().time < 0.05 && report.fault.kind == cluster::FaultKind::none) {
      report = simulation.run_epoch(0.05);
      largest = std::max(largest, std::abs(motion_of(model, simulation.state(), 0).velocity.z));
    }
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    EXPECT_LE(largest, 0.5001) << mass;
    EXPECT_LT(simulation.extremes().energy_error, 0.05) << mass;
    return simulation.extremes().smallest_dt;
  };
  EXPECT_LT(smallest_step(0.02), 0.5 * smallest_step(1000.0));
}

TEST(walls_with_mass, one_on_each_side_of_a_body_squeeze_it) {
  Description d = plate();
  add_plane(d, "below", -0.05, 1.0, 4.0).initial_velocity = {0.0, 0.0, 1.0};
  add_plane(d, "above", 0.05, -1.0, 4.0).initial_velocity = {0.0, 0.0, -1.0};
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const cluster::EpochReport report = run(simulation, 0.5);
  ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  EXPECT_EQ(report.islands, 1);
  EXPECT_LT(motion_of(model, simulation.state(), 0).velocity.z, 0.0);
  EXPECT_GT(motion_of(model, simulation.state(), 1).velocity.z, 0.0);
  EXPECT_LT(simulation.extremes().linear_momentum_error, 1e-12);
  EXPECT_LT(simulation.extremes().energy_error, 0.05);
}

/// A wall at rest that is struck, one that touches nothing, and one that comes to a body that is held altogether, which
/// it goes through.
TEST(walls_with_mass, wait_until_something_comes) {
  Description d = plate();
  d.contact.enabled = true;
  d.bodies[0].velocity = {0.0, 0.0, -3.0};
  test::add_body(d, "block", model::Plate{1.0, 1.0, 2, 2, "one"}).translate = {5.0, 0.0, 0.0};
  d.node_sets.emplace_back().name = "block";
  d.node_sets.back().bodies = {"block"};
  test::fix(d, "block", {"x", "y", "z", "rx", "ry", "rz"});
  add_plane(d, "table", -0.3, 1.0, 50.0);
  add_sphere(d, "alone", {0.0, 9.0, 9.0}, 1.0);
  add_sphere(d, "ghost", {5.5, 0.5, 0.3}, 1.0).initial_velocity = {0.0, 0.0, -2.0};
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_EQ(simulation.present().islands, 4) << "the plate, the table, and two spheres";
  const cluster::EpochReport report = run(simulation, 0.4);
  ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  EXPECT_LT(motion_of(model, simulation.state(), 0).velocity.z, -0.3);
  EXPECT_EQ(motion_of(model, simulation.state(), 1).velocity, Vec3d{});
  EXPECT_EQ(motion_of(model, simulation.state(), 2).velocity, (Vec3d{0.0, 0.0, -2.0}));
  EXPECT_LT(simulation.extremes().energy_error, 0.02);
}

TEST(walls_with_mass, are_in_one_island_with_all_that_may_come_to_them) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] { return Vec3d{number(random), number(random), number(random)}; };
  int reached = 0, apart = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Wall wall;
    wall.shape = static_cast<WallShape>(trial % 3);
    const Vec3d direction = vector();
    wall.direction = (1.0 / norm(direction)) * direction;
    wall.radius = 0.6 + 0.5 * number(random);
    wall.inside = trial % 2 == 1;
    const Vec3d point = vector(), place = 2.0 * vector();
    const Box points = Box{point, point}.grown(0.1 + 0.1 * number(random));
    const Box body = Box{place, place}.grown(0.2 + 0.2 * number(random));
    bool touches = false;
    const auto inside = [&](const Box& box) {
      const Vec3d s = 0.5 * (vector() + Vec3d{1.0, 1.0, 1.0}), edges = box.high - box.low;
      return box.low + Vec3d{s.x * edges.x, s.y * edges.y, s.z * edges.z};
    };
    for (int sample = 0; sample < 30 && !touches; ++sample) {
      const Vec3d p = sample == 0 ? point : inside(points), x = sample == 0 ? place : inside(body);
      touches = solve::wall_distance(wall, p, x).distance <= 0.0;
    }
    const bool may = cluster::may_reach(wall, points, body);
    EXPECT_TRUE(may || !touches) << "trial " << trial;
    reached += touches ? 1 : 0;
    apart += may ? 0 : 1;
  }
  EXPECT_GT(reached, 500);
  EXPECT_GT(apart, 500);
}

TEST(walls_with_mass, have_a_stiffness_in_series_with_that_of_the_node) {
  Description d = plate();
  add_plane(d, "light", 0.005, -1.0, 1.0e-3);
  add_plane(d, "told", 0.005, -1.0, -1.0);
  add_plane(d, "given", 0.005, -1.0, 1.0e-3).stiffness = 7.0;
  const model::Model model = test::build(d);
  const auto stiffness = [&](std::size_t w) {
    return solve::wall_reaction(model, model.walls[w], model.walls[w].point, 12, model.reference_position[12])
        .stiffness;
  };
  const double frequency = 0.3 / model.first_critical_step, square = frequency * frequency, mass = model.mass[12];
  EXPECT_NEAR(stiffness(0) * (1.0 / mass + 1.0e3), square, 1e-12 * square);
  EXPECT_EQ(stiffness(1), model.contact_stiffness[12]);
  EXPECT_EQ(stiffness(2), 7.0);
}

TEST(wall_penetrations, are_counted_by_body_and_wall) {
  Description d = plate();
  test::add_body(d, "high", model::Plate{1.0, 1.0, 2, 2, "one"}).translate = {0.0, 0.0, 1.0};
  RigidPlane& floor = add_plane(d, "floor", -0.01, 1.0, -1.0);
  EXPECT_TRUE(solve::find_wall_penetrations(test::build(d)).empty()) << "it touches and no more";
  floor.point.z = -0.009;
  add_sphere(d, "ball", {0.0, 0.0, 0.15}, 1.0);
  const std::vector<solve::WallPenetration> found = solve::find_wall_penetrations(test::build(d));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].body, 0);
  EXPECT_EQ(found[0].wall, 0);
  EXPECT_EQ(found[0].count, 25);
  EXPECT_NEAR(found[0].depth, 0.001, 1e-12);
  EXPECT_EQ(found[0].contact_distance, 0.01);
  EXPECT_EQ(found[1].wall, 1);
  EXPECT_EQ(found[1].count, 1);
  EXPECT_NEAR(found[1].depth, 0.06, 1e-12);
}

TEST(wall_faults, name_the_wall_that_makes_the_step_collapse) {
  for (const double mass : {-1.0, 1.0e-9}) {
    Description d = plate();
    RigidPlane& lid = add_plane(d, "lid", 0.0101, -1.0, mass);
    (mass > 0.0 ? lid.initial_velocity : lid.velocity) = {0.0, 0.0, -1.0};
    lid.stiffness = mass > 0.0 ? 1.0e6 : 1.0e14;
    const model::Model model = test::build(d);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    const cluster::EpochReport report = run(simulation, 0.05);
    ASSERT_EQ(report.fault.kind, cluster::FaultKind::step_collapsed) << report.fault.message;
    EXPECT_NE(report.fault.message.find("rigid wall \"lid\""), std::string::npos) << report.fault.message;
    EXPECT_NE(report.fault.message.find("of body \"plate\""), std::string::npos) << report.fault.message;
    EXPECT_EQ(report.fault.cure.find("it more mass") != std::string::npos, mass > 0.0) << report.fault.cure;
    EXPECT_EQ(report.fault.body, 0);
    EXPECT_NE(report.fault.element, no_index);
  }
}

}  // namespace
}  // namespace fexp::walls_with_mass
