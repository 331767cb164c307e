// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "cluster/simulation.hpp"
#include "quality/crossing_watch.hpp"
#include "support/contact.hpp"
#include "support/crossings.hpp"

/// Scenes that are known to be hard for contact: in each something touches, nothing comes through, and energy and
/// momenta are kept.
namespace fexp::hard_contact {
namespace {

struct EncounterOutcome {
  Index most_pairs{};
  std::size_t edges_through{};  ///< Most at the end of an epoch that are not there at the start
  std::size_t nodes_through{};  ///< Most at the end of an epoch
  double first_time{-1.0};      ///< When something was through
  Index steps{};
  Vec3d last_centre;  ///< Of the last body's nodes, at the end
  cluster::RunExtremes extremes;
  std::string fault;
};

/// Runs to the end of the description's duration and looks for crossings every few steps.
EncounterOutcome run(const model::Model& model) {
  EncounterOutcome outcome;
  const quality::Surfaces surfaces = test::surfaces_of(model);
  const std::vector<char> alive(surfaces.triangle.size(), 1);
  quality::CrossingWatch watch(surfaces);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const auto look = [&] {
    const quality::FrameCrossings found = watch.look(test::positions_of(simulation.state()), alive);
    outcome.edges_through = std::max(outcome.edges_through, found.new_cuts.size());
    outcome.nodes_through = std::max(outcome.nodes_through, found.through.size());
    if (outcome.first_time < 0.0 && found.new_cuts.size() + found.through.size() > 0) {
      outcome.first_time = simulation.state().time;
    }
  };
  look();
  while (simulation.state().time < model.run.duration && outcome.fault.empty()) {
    const cluster::EpochReport report = simulation.run_epoch(model.run.duration);
    outcome.fault = report.fault.message;
    outcome.steps += report.steps;
    look();
  }
  outcome.extremes = simulation.extremes();
  outcome.most_pairs = outcome.extremes.most_active_pairs;
  const IndexRange nodes = model.bodies.back().nodes;
  for (Index n = nodes.begin; n < nodes.end; ++n) {
    outcome.last_centre += (1.0 / nodes.size()) * simulation.state().motion[at(n)].position;
  }
  return outcome;
}

EncounterOutcome expect_sound(const model::Model& model) {
  EncounterOutcome outcome = run(model);
  const cluster::RunExtremes& x = outcome.extremes;
  std::printf("%d elements, %d steps, %d pairs, depth %.2f, energy %.1e, momenta %.1e %.1e, through %zu %zu (at %g)\n",
              model.element_count(), outcome.steps, outcome.most_pairs, x.deepest, x.energy_error,
              x.linear_momentum_error, x.angular_momentum_error, outcome.edges_through, outcome.nodes_through,
              outcome.first_time);
  EXPECT_EQ(outcome.fault, "");
  EXPECT_GT(outcome.most_pairs, 0);
  EXPECT_EQ(outcome.edges_through, 0U) << "first at " << outcome.first_time;
  EXPECT_EQ(outcome.nodes_through, 0U) << "first at " << outcome.first_time;
  EXPECT_LT(x.deepest, 1.0) << "in contact distances, in any step";
  EXPECT_LE(x.energy_error, 0.01);
  EXPECT_LE(x.linear_momentum_error, 1e-12);
  EXPECT_LE(x.angular_momentum_error, 1e-12);
  return outcome;
}

/// A scene of rubber, looked at every few steps. Its speed of sound is 33.
model::Description scene(double thickness, double duration) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, thickness);
  d.contact.enabled = true;
  d.run.duration = duration;
  d.run.epoch_steps = 8;
  return d;
}

void hold(model::Description& d, const std::string& body) {
  model::NodeSet set;
  set.name = body;
  set.bodies = {body};
  d.node_sets.push_back(set);
  test::fix(d, body, {"x", "y", "z", "rx", "ry", "rz"});
}

void turn(model::BodyDescription& body, const Vec3d& axis, double degrees) {
  body.rotate.push_back({axis, degrees, {}});
}

/// A closed cube from -half to half, with cells as those of a cubed sphere.
model::Mesh cube(double half, int cells) {
  model::Mesh m = model::generate_mesh(model::CubedSphere{1.0, cells});
  for (Vec3d& x : m.position) {
    x = (half / std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)})) * x;
  }
  return m;
}

/// A plate that is folded along its middle, x = 0: the halves rise by `slope` to both sides, or fall.
model::Mesh folded(double length, int cells, double slope) {
  model::Mesh m = model::generate_mesh(test::plate(length, length, cells, cells));
  const double shorter = 1.0 / std::sqrt(1.0 + slope * slope);
  for (Vec3d& x : m.position) {
    const double along = x.x - 0.5 * length;
    x = {shorter * along, x.y - 0.5 * length, shorter * slope * std::abs(along)};
  }
  return m;
}

/// Ten sheets of thickness 0.01 above each other, no two with the same mesh, with gaps of a fifth of that.
model::Description ten_sheets(double duration) {
  auto d = scene(0.01, duration);
  for (int i = 0; i < 10; ++i) {
    const int cells = 5 + i % 3;
    model::BodyDescription& sheet = test::add_body(
        d, "sheet " + std::to_string(i), test::plate(1.0, 1.0, cells, cells + 1, i % 2 == 0 ? "one" : "crossed"));
    sheet.translate = {0.013 * (i % 4), 0.017 * (i % 3), 0.012 * (i + 1)};
  }
  return d;
}

void add_floor(model::Description& d) {
  d.planes.push_back({});
  d.planes.back().name = "floor";
  d.planes.back().normal = {0.0, 0.0, 1.0};
}

TEST(hard_contact, ten_thin_sheets_dropped_on_a_wall) {
  auto d = ten_sheets(0.25);
  add_floor(d);
  for (model::BodyDescription& sheet : d.bodies) {
    sheet.velocity = {0.0, 0.0, -0.3};
  }
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  expect_sound(test::build(d));
}

TEST(hard_contact, ten_thin_sheets_pressed_by_a_wall) {
  auto d = ten_sheets(0.2);
  add_floor(d);
  // All gaps, and a tenth of the sheets' thickness.
  d.curves.push_back({"press", {{0.0, 0.0}, {0.2, 1.0}}, {}});
  d.planes.push_back({});
  d.planes.back().name = "press";
  d.planes.back().point = {0.0, 0.0, 0.126};
  d.planes.back().normal = {0.0, 0.0, -1.0};
  d.planes.back().displacement = {0.0, 0.0, -0.036};
  d.planes.back().curve = "press";
  expect_sound(test::build(d));
}

TEST(hard_contact, ten_thin_sheets_pressed_on_a_plate_by_a_pressure) {
  auto d = ten_sheets(0.2);
  test::add_body(d, "plate", test::plate(1.4, 1.4, 3, 3)).translate = {-0.2, -0.2, 0.0};
  hold(d, "plate");
  d.curves.push_back({"press", {{0.0, 0.0}, {0.1, 1.0}}, {}});
  d.pressure.push_back({});
  d.pressure.back().bodies = {"sheet 9"};
  d.pressure.back().value = 300.0;
  d.pressure.back().curve = "press";
  expect_sound(test::build(d));
}

TEST(hard_contact, ten_thin_sheets_pressed_by_a_falling_plate) {
  auto d = ten_sheets(0.15);
  add_floor(d);
  d.sections.push_back({"heavy", "m", 0.1, {}});
  model::BodyDescription& plate = test::add_body(d, "plate", test::plate(1.2, 1.2, 4, 4));
  plate.section = "heavy";
  plate.translate = {-0.1, -0.1, 0.19};
  plate.velocity = {0.0, 0.0, -0.5};
  expect_sound(test::build(d));
}

TEST(hard_contact, a_fine_sphere_on_a_plate_twenty_times_as_coarse) {
  auto d = scene(0.01, 0.12);
  test::add_body(d, "plate", test::plate(1.04, 1.04, 4, 4)).translate = {-0.5, -0.5, 0.0};
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.1, 12});
  ball.translate = {0.03, 0.05, 0.12};
  ball.velocity = {0.2, 0.1, -1.0};
  expect_sound(test::build(d));
}

TEST(hard_contact, a_coarse_sphere_on_a_plate_twenty_times_as_fine) {
  auto d = scene(0.02, 0.08);
  test::add_body(d, "plate", test::plate(0.4, 0.4, 32, 32)).translate = {-0.2, -0.2, 0.0};
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.32, 2});
  turn(ball, {1.0, 2.0, 3.0}, 20.0);
  ball.translate = {0.01, 0.02, 0.35};
  ball.velocity = {0.1, 0.0, -1.0};
  expect_sound(test::build(d));
}

TEST(hard_contact, shells_twice_as_thick_as_their_elements) {
  auto d = scene(0.2, 0.15);
  test::add_body(d, "plate", test::plate(1.0, 1.0, 10, 10)).translate = {-0.5, -0.5, 0.0};
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.4, 6});
  ball.translate = {0.03, 0.02, 0.65};
  ball.velocity = {0.2, 0.0, -2.0};
  expect_sound(test::build(d));
}

TEST(hard_contact, shells_twice_as_thick_as_their_elements_face_to_face_and_edge_to_edge) {
  auto d = scene(0.2, 0.15);
  test::add_body(d, "plate", test::plate(1.0, 1.0, 10, 10)).translate = {-0.5, -0.5, 0.0};
  model::BodyDescription& other = test::add_body(d, "other", test::plate(0.7, 0.7, 7, 7, "crossed"));
  other.translate = {-0.31, -0.33, 0.25};
  other.velocity = {0.0, 0.0, -2.0};
  model::BodyDescription& beside = test::add_body(d, "beside", test::plate(1.0, 1.0, 10, 10));
  beside.translate = {0.75, -0.45, 0.03};
  turn(beside, {1.0, 0.0, 0.0}, 30.0);
  beside.velocity = {-2.0, 0.0, 0.0};
  expect_sound(test::build(d));
}

TEST(hard_contact, a_corner_that_slides_over_edges_and_off_a_rim) {
  // On one corner, over all edges of a plate that stands fast, off its rim, and down beside it.
  auto d = scene(0.02, 0.6);
  test::add_body(d, "plate", model::CubedSphere{});
  model::BodyDescription& box = test::add_body(d, "box", model::CubedSphere{});
  turn(box, {1.0, 1.0, 0.0}, 54.7);
  box.translate = {0.25, 0.03, 0.2};
  box.velocity = {1.5, 0.1, -0.2};
  hold(d, "plate");
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  model::Mesh plate = model::generate_mesh(test::plate(1.0, 1.0, 7, 7));
  for (Vec3d& x : plate.position) {
    x += Vec3d{-0.5, -0.5, 0.0};
  }
  const EncounterOutcome outcome = expect_sound(test::build(d, {plate, cube(0.1, 2)}));
  EXPECT_GT(outcome.last_centre.x, 0.7);
  EXPECT_LT(outcome.last_centre.z, -0.2);
}

TEST(hard_contact, a_ball_that_slides_over_a_ridge_and_off_a_rim) {
  auto d = scene(0.02, 0.8);
  test::add_body(d, "roof", model::CubedSphere{});
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
  ball.translate = {-0.3, 0.05, 0.06};
  ball.velocity = {2.0, 0.0, 0.0};
  hold(d, "roof");
  d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
  const EncounterOutcome outcome =
      expect_sound(test::build(d, {folded(1.0, 8, -0.3), model::generate_mesh(model::CubedSphere{0.1, 3})}));
  EXPECT_GT(outcome.last_centre.x, 0.7);
  EXPECT_LT(outcome.last_centre.z, -0.2);
}

TEST(hard_contact, the_fold_of_a_wedge_into_a_plate) {
  auto d = scene(0.02, 0.25);
  test::add_body(d, "plate", model::CubedSphere{});
  model::BodyDescription& wedge = test::add_body(d, "wedge", model::CubedSphere{});
  turn(wedge, {1.0, 0.0, 0.0}, 10.0);
  wedge.translate = {0.03, 0.02, 0.1};
  wedge.velocity = {0.0, 0.0, -1.0};
  model::Mesh plate = model::generate_mesh(test::plate(1.0, 1.0, 6, 6));
  for (Vec3d& x : plate.position) {
    x += Vec3d{-0.5, -0.5, 0.0};
  }
  expect_sound(test::build(d, {plate, folded(0.6, 6, 3.0)}));
}

TEST(hard_contact, the_tip_of_a_pyramid_into_a_plate) {
  auto d = scene(0.02, 0.25);
  test::add_body(d, "plate", model::CubedSphere{});
  model::BodyDescription& tip = test::add_body(d, "tip", model::CubedSphere{});
  tip.translate = {0.03, 0.02, 0.03};
  tip.velocity = {0.1, 0.0, -1.0};
  model::Mesh plate = model::generate_mesh(test::plate(1.0, 1.0, 6, 6));
  for (Vec3d& x : plate.position) {
    x += Vec3d{-0.5, -0.5, 0.0};
  }
  // The apex and two rings of four.
  const model::Mesh pyramid = test::mesh({{0.0, 0.0, 0.0},
                                          {0.05, 0.0, 0.15},
                                          {0.0, 0.05, 0.15},
                                          {-0.05, 0.0, 0.15},
                                          {0.0, -0.05, 0.15},
                                          {0.1, 0.0, 0.3},
                                          {0.0, 0.1, 0.3},
                                          {-0.1, 0.0, 0.3},
                                          {0.0, -0.1, 0.3}},
                                         {{0, 2, 1},
                                          {0, 3, 2},
                                          {0, 4, 3},
                                          {0, 1, 4},
                                          {1, 2, 6},
                                          {1, 6, 5},
                                          {2, 3, 7},
                                          {2, 7, 6},
                                          {3, 4, 8},
                                          {3, 8, 7},
                                          {4, 1, 5},
                                          {4, 5, 8}});
  expect_sound(test::build(d, {plate, pyramid}));
}

TEST(hard_contact, the_corner_of_a_cube_on_the_edge_of_another) {
  auto d = scene(0.03, 0.3);
  model::BodyDescription& a = test::add_body(d, "edge up", model::CubedSphere{});
  turn(a, {0.0, 1.0, 0.0}, 45.0);
  model::BodyDescription& b = test::add_body(d, "corner down", model::CubedSphere{});
  turn(b, {1.0, 1.0, 0.0}, 54.7);
  const double half = 0.25;
  b.translate = {0.01, 0.02, half * (std::sqrt(2.0) + std::sqrt(3.0)) + 0.04};
  b.velocity = {0.0, 0.0, -1.5};
  expect_sound(test::build(d, {cube(half, 4), cube(half, 4)}));
}

/// A valley comes down across a roof.
model::Model crossed_folds(double penalty_scale = 1.0, double hardening = model::ContactSettings::usual_hardening) {
  auto d = scene(0.02, 0.25);
  d.contact.penalty_scale = penalty_scale;
  d.contact.hardening = hardening;
  test::add_body(d, "roof", model::CubedSphere{});
  model::BodyDescription& valley = test::add_body(d, "valley", model::CubedSphere{});
  turn(valley, {0.0, 0.0, 1.0}, 73.0);
  valley.translate = {0.013, 0.017, 0.05};
  valley.velocity = {0.0, 0.0, -1.0};
  return test::build(d, {folded(0.8, 6, -0.7), folded(0.8, 7, 0.7)});
}

TEST(hard_contact, folds_across_each_other) { expect_sound(crossed_folds()); }

TEST(hard_contact, is_seen_to_give_way_where_the_penalty_is_too_soft) {
  const EncounterOutcome outcome = run(crossed_folds(0.1, 0.0));
  EXPECT_GT(outcome.edges_through, 0U);
  EXPECT_GT(outcome.nodes_through, 0U);
  EXPECT_GT(outcome.first_time, 0.0);
}

TEST(hard_contact, a_ball_into_a_fold) {
  auto d = scene(0.02, 0.3);
  test::add_body(d, "valley", model::CubedSphere{});
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
  ball.translate = {0.02, 0.03, 0.35};
  ball.velocity = {0.1, 0.0, -1.5};
  expect_sound(test::build(d, {folded(1.0, 8, 1.5), model::generate_mesh(model::CubedSphere{0.15, 4})}));
}

TEST(hard_contact, a_fast_impact_at_a_tenth_of_the_speed_of_sound) {
  // Shells of half an element's size, so that what is stopped in that thickness is not through.
  auto d = scene(0.05, 0.15);
  test::add_body(d, "plate", test::plate(1.0, 1.0, 10, 10)).translate = {-0.5, -0.5, 0.0};
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.2, 4});
  ball.translate = {0.03, 0.02, 0.3};
  ball.velocity = {0.0, 0.0, -3.3};
  expect_sound(test::build(d));
}

/// Meshes that are one where they have nodes in common.
model::Mesh joined(const std::vector<model::Mesh>& parts) {
  model::Mesh all = parts.front();
  for (std::size_t p = 1; p < parts.size(); ++p) {
    std::vector<Index> number;
    for (const Vec3d& x : parts[p].position) {
      const auto found =
          std::ranges::find_if(all.position, [&](const Vec3d& known) { return norm(known - x) < 1.0e-9; });
      number.push_back(static_cast<Index>(found - all.position.begin()));
      if (found == all.position.end()) {
        all.position.push_back(x);
      }
    }
    for (const auto& t : parts[p].triangle) {
      all.triangle.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
      all.part.push_back(0);
    }
  }
  return all;
}

/// A plate of 1 by 1 with `place` for its coordinates u from -1/2 to 1/2 and v from 0 to 1.
template <class Place>
model::Mesh sheet(int cells, const Place& place) {
  model::Mesh m = model::generate_mesh(test::plate(1.0, 1.0, cells, cells, "one"));
  for (Vec3d& x : m.position) {
    x = place(x.x - 0.5, x.y);
  }
  return m;
}

/// A flange, which falls off to both sides by `slope`, and a web below its middle, along y.
model::Mesh flange_on_web(double slope) {
  return joined({sheet(8,
                       [&](double u, double v) {
                         return Vec3d{u, v, -slope * std::abs(u)};
                       }),
                 sheet(8, [](double u, double v) {
                   return Vec3d{0.0, v, u - 0.5};
                 })});
}

/// A ball thrown at the middle of the flange from above, at the corner of flange and web from below, and at the web.
TEST(hard_contact, balls_on_a_flange_above_its_web_and_in_the_corners) {
  struct Throw {
    Vec3d from, velocity;
  };
  const std::array<Throw, 5> throws{{{{-0.25, 0.53, 0.16}, {1.0, 0.0, -0.5}},
                                     {{0.0, 0.5, 0.2}, {0.0, 0.0, -1.5}},
                                     {{0.3, 0.47, -0.3}, {-1.0, 0.0, 0.9}},
                                     {{-0.25, 0.5, -0.4}, {1.0, 0.1, 0.3}},
                                     {{0.15, 0.4, -0.2}, {-0.6, 0.3, 0.6}}}};
  for (const double slope : {0.0, 0.2, -0.3}) {
    for (const Throw& thrown : throws) {
      auto d = scene(0.02, 0.3);
      test::add_body(d, "profile", model::CubedSphere{});
      model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
      ball.translate = thrown.from + Vec3d{0.0, 0.0, thrown.from.z > 0.0 && slope < 0.0 ? 0.1 : 0.0};
      ball.velocity = thrown.velocity;
      SCOPED_TRACE(testing::Message() << slope << ", from " << thrown.from.x);
      expect_sound(test::build(d, {flange_on_web(slope), model::generate_mesh(model::CubedSphere{0.1, 3})}));
    }
  }
}

/// Webs across each other, and a flange on both: edges of three and of four sheets, and a node where all of them meet.
TEST(hard_contact, balls_on_webs_across_each_other_and_in_their_corners) {
  const std::array<std::array<Vec3d, 2>, 3> throws{{{Vec3d{0.02, 0.03, 0.16}, Vec3d{0.1, 0.0, -1.5}},
                                                    {Vec3d{0.3, 0.25, -0.3}, Vec3d{-1.0, -0.8, 0.5}},
                                                    {Vec3d{0.2, -0.25, -0.35}, Vec3d{-0.8, 1.0, 0.7}}}};
  const model::Mesh webs = joined({sheet(8,
                                         [](double u, double v) {
                                           return Vec3d{u, v - 0.5, 0.0};
                                         }),
                                   sheet(8,
                                         [](double u, double v) {
                                           return Vec3d{0.0, v - 0.5, u - 0.5};
                                         }),
                                   sheet(8, [](double u, double v) {
                                     return Vec3d{v - 0.5, 0.0, u - 0.5};
                                   })});
  for (const auto& [from, velocity] : throws) {
    auto d = scene(0.02, 0.3);
    test::add_body(d, "webs", model::CubedSphere{});
    model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
    ball.translate = from;
    ball.velocity = velocity;
    SCOPED_TRACE(testing::Message() << "from " << from.x << ", " << from.y);
    expect_sound(test::build(d, {webs, model::generate_mesh(model::CubedSphere{0.1, 3})}));
  }
}

/// A rim that lies along faces of the ball, over none of its corners.
TEST(hard_contact, a_ball_head_on_into_a_rim) {
  auto d = scene(0.02, 0.3);
  test::add_body(d, "plate", model::CubedSphere{});
  model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
  ball.translate = {0.02, -0.15, -0.05};
  ball.velocity = {0.0, 1.0, 0.1};
  expect_sound(test::build(d, {sheet(8,
                                     [](double u, double v) {
                                       return Vec3d{0.0, v, u};
                                     }),
                               model::generate_mesh(model::CubedSphere{0.1, 3})}));
}

TEST(hard_contact, a_ball_that_rubs_in_a_roof_with_and_without_a_web) {
  const model::Mesh roof = sheet(8, [](double u, double v) { return Vec3d{u, v, -0.5 * std::abs(u)}; });
  for (const model::Mesh& mesh : {flange_on_web(0.5), roof}) {
    auto d = scene(0.02, 0.3);
    test::add_body(d, "profile", model::CubedSphere{});
    model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{});
    ball.translate = {0.15, 0.4, -0.23};
    ball.velocity = {-0.6, 0.3, 0.6};
    expect_sound(test::build(d, {mesh, model::generate_mesh(model::CubedSphere{0.1, 3})}));
  }
}

}  // namespace
}  // namespace fexp::hard_contact
