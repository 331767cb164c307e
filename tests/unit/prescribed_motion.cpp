// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cluster/simulation.hpp"
#include "cluster/swept_boxes.hpp"
#include "model/held_directions.hpp"
#include "solve/diagnostics.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using test::rubber;

model::Curve bump() { return {"bump", {{0.0, 0.0}, {0.05, 1.0}, {0.12, -0.4}, {0.2, 0.3}}, {}}; }

model::Description plate_description(int cells = 4) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, cells, cells, "one"});
  test::add_box_set(d, "left", {-0.01, -1.0, -1.0}, {0.01, 2.0, 1.0});
  test::add_box_set(d, "right", {0.99, -1.0, -1.0}, {1.01, 2.0, 1.0});
  d.curves.push_back(bump());
  return d;
}

model::Prescribed displacement(const std::string& set, const std::string& dof, double size) {
  model::Prescribed p;
  p.set = set;
  p.dof = dof;
  p.displacement = size;
  p.curve = "bump";
  return p;
}

model::Prescribed acceleration(const std::string& set, const std::string& dof, double size, const std::string& curve) {
  model::Prescribed p;
  p.set = set;
  p.dof = dof;
  p.acceleration = size;
  p.curve = curve;
  return p;
}

TEST(curves, have_the_slope_and_the_integral_of_their_points) {
  auto d = plate_description();
  d.curves.push_back({"late", {{1.0, 2.0}, {3.0, 6.0}}, {}});
  const model::Model model = test::build(d);
  const auto slope = [&](Index curve, double t) { return model::curve_slope(model, curve, t); };
  const auto integral = [&](Index curve, double t) { return model::curve_integral(model, curve, t); };
  EXPECT_EQ(slope(no_index, 1.0), 0.0);
  EXPECT_EQ(integral(no_index, 1.5), 1.5);
  EXPECT_EQ(slope(0, -0.1), 0.0);
  EXPECT_DOUBLE_EQ(slope(0, 0.01), 20.0);
  EXPECT_DOUBLE_EQ(slope(0, 0.0), 10.0) << "the mean of rest and ascent";
  EXPECT_DOUBLE_EQ(slope(0, 0.05), 0.0) << "the mean of 20 and -20";
  EXPECT_DOUBLE_EQ(slope(0, 0.2), 0.5 * 0.7 / 0.08);
  EXPECT_EQ(slope(0, 0.3), 0.0);
  EXPECT_DOUBLE_EQ(integral(0, 0.05), 0.025);
  EXPECT_DOUBLE_EQ(integral(0, 0.025), 0.00625);
  EXPECT_DOUBLE_EQ(integral(0, 0.12), 0.025 + 0.07 * 0.3);
  EXPECT_DOUBLE_EQ(integral(0, 1.2), 0.025 + 0.07 * 0.3 + 0.08 * -0.05 + 0.3);
  EXPECT_DOUBLE_EQ(integral(1, 0.5), 1.0) << "constant before its first point";
  EXPECT_DOUBLE_EQ(integral(1, 3.0), 2.0 + 8.0);
  EXPECT_EQ(integral(1, 0.0), 0.0);
}

TEST(prescribed_displacement, is_where_its_curve_is_at_every_step_whatever_the_steps) {
  auto d = plate_description();
  d.prescribed.push_back(displacement("right", "z", 0.1));
  d.prescribed.push_back(displacement("right", "x", -0.05));
  test::fix(d, "left", {"x", "y", "z"});
  const model::Model model = test::build(d);
  const std::vector<Index> nodes = test::nodes_of(model, "right");
  test::DirectRun run(model);
  for (int i = 0; run.state.time < 0.25; ++i) {
    run.advance((0.1 + 0.05 * (i % 7)) * model.first_critical_step, 1);
    const double factor = model::curve_value(model, 0, run.state.time);
    for (const Index n : nodes) {
      const Vec3d moved = run.state.motion[at(n)].position - model.reference_position[at(n)];
      ASSERT_NEAR(moved.z, 0.1 * factor, 1e-15) << run.state.time;
      ASSERT_NEAR(moved.x, -0.05 * factor, 1e-15) << run.state.time;
    }
  }
  EXPECT_GT(run.state.step, 100);
}

TEST(prescribed_displacement, of_rotations_turns_by_the_curve) {
  auto d = plate_description();
  d.prescribed.push_back(displacement("right", "ry", 0.3));
  const model::Model model = test::build(d);
  const Index node = test::nodes_of(model, "right").front();
  test::DirectRun run(model);
  double angle = 0.0;
  const double dt = 0.5 * model.first_critical_step;
  for (int i = 0; i < 200; ++i) {
    // The rate at mid-step is what the step turns by; it is the difference of the curve.
    angle = 0.3 * model::curve_value(model, 0, run.state.time + dt);
    run.advance(dt, 1);
    ASSERT_NEAR(angle, 0.3 * model::curve_value(model, 0, run.state.time), 1e-12);
    ASSERT_NEAR(run.state.motion[at(node)].rotation_rate.y, 0.3 * model::curve_slope(model, 0, run.state.time), 1e-9);
  }
}

TEST(prescribed_displacement, does_the_work_that_strains_the_body) {
  auto d = test::description({1000.0, 1.0e6, 0.0}, 0.02);
  test::add_body(d, "strip", model::Plate{1.0, 1.0, 4, 4, "one"});
  test::add_box_set(d, "left", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  test::add_box_set(d, "right", {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0});
  test::fix(d, "left", {"x"});
  // A smooth start and end of a parabola's pieces, so slow that all work becomes strain energy.
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i <= 40; ++i) {
    const double s = i / 40.0;
    points.push_back({2.0 * s, s * s * (3.0 - 2.0 * s)});
  }
  d.curves.push_back({"bump", points, {}});
  d.prescribed.push_back(displacement("right", "x", 0.001));
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const auto steps = static_cast<Index>(std::ceil(4.0 / model.first_critical_step));
  run.advance(2.0 / steps, steps);
  const double exact = 0.5 * 1.0e6 * 0.02 * 0.001 * 0.001;
  const solve::Energies e = solve::diagnostics(model, run.state).energies;
  EXPECT_NEAR(e.external, exact, 5e-3 * exact);
  EXPECT_NEAR(e.internal, exact, 5e-3 * exact);
}

TEST(prescribed_acceleration, integrates_its_curve_from_the_initial_velocity) {
  auto d = plate_description();
  d.bodies[0].velocity = {1.0, 0.0, 3.0};
  d.prescribed.push_back(acceleration("all", "z", -10.0, ""));
  d.prescribed.push_back(acceleration("all", "x", 4.0, "bump"));
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  // Steps meet the corners of the curve.
  const double dt = 0.01 / 100.0;
  run.advance(dt, 2500);
  const double integral = 0.025 + 0.021 - 0.004 + 0.05 * 0.3;
  for (Index n = 0; n < model.node_count(); ++n) {
    const model::NodeMotion& motion = run.state.motion[at(n)];
    EXPECT_NEAR(motion.velocity.z, 3.0 - 10.0 * 0.25, 1e-13);
    EXPECT_NEAR(motion.velocity.x, 1.0 + 4.0 * integral, 1e-13);
    EXPECT_NEAR(motion.position.z, 3.0 * 0.25 - 5.0 * 0.0625, 1e-12);
  }
  const double mass = model.bodies[0].mass;
  EXPECT_NEAR(run.state.ledger[0].external_impulse.z, -2.5 * mass, 1e-11 * mass);
  EXPECT_NEAR(run.state.ledger[0].external_work,
              0.5 * mass * (0.25 + (1.0 + 4.0 * integral) * (1.0 + 4.0 * integral) - 10.0), 1e-10 * mass);
}

/// Turns by 50 degrees about an axis that is none of the model's.
model::Rotation turn() { return {{1.0, 2.0, 3.0}, 50.0, {0.2, -0.1, 0.4}}; }

Vec3d turned(const Vec3d& v) {
  const model::Rotation r = turn();
  const Vec3d axis = (1.0 / norm(r.axis)) * r.axis;
  const double angle = r.angle_degrees * 3.14159265358979323846 / 180.0;
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1.0 - std::cos(angle)) * dot(axis, v)) * axis;
}

model::LocalAxes turned_axes() { return {turned({1.0, 0.0, 0.0}), turned({0.7, 0.2, 0.0})}; }

/// Positions at the end of a plate's motion with these conditions, in the plate's own axes.
template <class Conditions>
std::vector<Vec3d> end_positions(bool rotated, const Conditions& conditions) {
  auto d = test::description(rubber, 0.02);
  model::BodyDescription& body = test::add_body(d, "plate", model::Plate{1.0, 1.0, 5, 5, "one"});
  d.curves.push_back(bump());
  model::NodeSet rim;
  rim.name = "rim";
  rim.boundary = true;
  d.node_sets.push_back(rim);
  body.velocity = {0.3, 0.4, 2.0};
  body.angular_velocity = {1.0, 0.5, -2.0};
  conditions(d);
  if (rotated) {
    body.rotate.push_back(turn());
    body.velocity = turned(body.velocity);
    body.angular_velocity = turned(body.angular_velocity);
    for (model::Fixed& fixed : d.fixed) {
      fixed.axes = turned_axes();
    }
    for (model::Prescribed& p : d.prescribed) {
      p.axes = turned_axes();
    }
  }
  const model::Model model = test::build(d);
  EXPECT_EQ(!model.oblique.empty(), rotated && d.fixed.front().dofs.size() < 3);
  test::DirectRun run(model);
  run.advance(5.0e-5, 2000);
  const solve::Diagnostics end = solve::diagnostics(model, run.state);
  EXPECT_NEAR(end.energies.balance(), solve::diagnostics(model, model::initial_state(model)).energies.balance(),
              1e-2 * (end.energies.kinetic + end.energies.internal));
  std::vector<Vec3d> positions(at(model.node_count()));  // By label
  const auto first = std::find(model.node_label.begin(), model.node_label.end(), 0) - model.node_label.begin();
  const Vec3d origin = model.reference_position[static_cast<std::size_t>(first)];
  const Vec3d x = rotated ? turned({1.0, 0.0, 0.0}) : Vec3d{1.0, 0.0, 0.0};
  const Vec3d y = rotated ? turned({0.0, 1.0, 0.0}) : Vec3d{0.0, 1.0, 0.0};
  for (Index n = 0; n < model.node_count(); ++n) {
    const Vec3d r = run.state.motion[at(n)].position - origin;
    positions[static_cast<std::size_t>(model.node_label[at(n)])] = {dot(r, x), dot(r, y), dot(r, cross(x, y))};
  }
  return positions;
}

TEST(local_axes, of_conditions_give_the_motion_of_the_model_turned_round) {
  const auto compare = [](const auto& conditions) {
    const std::vector<Vec3d> straight = end_positions(false, conditions), oblique = end_positions(true, conditions);
    ASSERT_EQ(straight.size(), oblique.size());
    double largest = 0.0;
    for (std::size_t n = 0; n < straight.size(); ++n) {
      largest = std::max(largest, norm(straight[n] - oblique[n]));
    }
    EXPECT_LT(largest, 1e-10);
  };
  compare([](model::Description& d) { test::fix(d, "rim", {"z"}); });
  compare([](model::Description& d) { test::fix(d, "rim", {"x", "rx"}); });
  compare([](model::Description& d) { test::fix(d, "rim", {"x", "z"}); });
  compare([](model::Description& d) { test::fix(d, "rim", {"x", "y", "z"}); });
  compare([](model::Description& d) {
    test::fix(d, "rim", {"x"});
    d.prescribed.push_back(displacement("rim", "z", 0.05));
    d.prescribed.push_back({"rim", "y", 0.3, "bump", {}});
    d.prescribed.push_back(displacement("rim", "rx", 0.05));
  });
  compare([](model::Description& d) {
    test::fix(d, "rim", {"ry"});
    d.prescribed.push_back(acceleration("rim", "z", 30.0, "bump"));
  });
}

TEST(local_axes, that_are_the_model_s_give_the_same_bits) {
  const auto run = [](bool given) {
    auto d = plate_description();
    test::fix(d, "left", {"x", "z"});
    d.prescribed.push_back(displacement("right", "z", 0.1));
    if (given) {
      d.fixed[0].axes = model::LocalAxes{{2.0, 0.0, 0.0}, {1.0, 3.0, 0.0}};
      d.prescribed[0].axes = d.fixed[0].axes;
    }
    const model::Model model = test::build(d);
    test::DirectRun direct(model);
    direct.advance(1.0e-4, 500);
    return model::state_hash(model, direct.state);
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(local_axes, held_directions_are_orthogonal_to_all_that_is_held_there) {
  auto d = plate_description();
  test::fix(d, "left", {"x"});
  d.symmetry.push_back({"left", {0.0, 0.0, 1.0}, {}});
  model::Fixed oblique{"left", {"x", "ry"}, {}, model::LocalAxes{{1.0, 1.0, 1.0}, {0.0, 1.0, 0.0}}};
  d.fixed.push_back(oblique);
  d.fixed.push_back(oblique);  // Adds nothing.
  const model::Model model = test::build(d);
  const std::vector<Index> nodes = test::nodes_of(model, "left");
  ASSERT_EQ(model.oblique.size(), 2 * nodes.size());
  for (const model::ObliqueNode& item : model.oblique) {
    if (item.angular) {
      EXPECT_LT(norm(cross(item.direction, {0.0, 0.0, 1.0})), 1e-15) << "all that symmetry leaves";
    } else {
      EXPECT_LT(norm(item.direction - Vec3d{0.0, 1.0, 0.0}), 1e-15) << "x is fixed, z by symmetry";
    }
    EXPECT_EQ(norm(model::free_part(model, item.node, item.angular, item.direction)), 0.0);
  }
  const model::State start = model::initial_state(model);
  EXPECT_EQ(start.motion[at(nodes[0])].velocity, Vec3d{});
}

TEST(local_axes, that_hold_everything_make_a_barrier) {
  auto d = plate_description();
  d.fixed.push_back({"all", {"x", "y", "z", "rx", "ry", "rz"}, {}, model::LocalAxes{{1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}}});
  EXPECT_TRUE(test::build(d).bodies[0].barrier);
}

TEST(swept_boxes, allow_for_prescribed_displacements_and_accelerations) {
  const auto allowance = [](const model::Prescribed& p) {
    auto d = plate_description();
    d.prescribed.push_back(p);
    const model::Model model = test::build(d);
    const cluster::BodyExtent extent = cluster::extent_of(model, model::initial_state(model), 0);
    return cluster::travel_allowance(model, 0, extent, 1.0e-3, 50);
  };
  EXPECT_GE(allowance(displacement("right", "z", 0.1)), 0.05 * 2.0) << "the steepest slope is 20";
  EXPECT_GE(allowance(acceleration("right", "z", 100.0, "bump")), 0.5 * 100.0 * 0.05 * 0.05);
  EXPECT_LT(allowance(acceleration("right", "rz", 100.0, "bump")), 0.1) << "rotations move no node";
}

}  // namespace
}  // namespace fexp
