// SPDX-License-Identifier: Apache-2.0
#include "cluster/swept_boxes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "solve/island_solver.hpp"
#include "support/models.hpp"

namespace fexp::cluster {
namespace {

using test::rubber;

model::Plate square_plate(double side, int cells) {
  model::Plate p;
  p.length_x = p.length_y = side;
  p.cells_x = p.cells_y = cells;
  return p;
}

std::vector<double> travel_allowance(const model::Model& model, const model::State& state, double dt, Index steps) {
  std::vector<double> allowance;
  for (Index b = 0; b < model.body_count(); ++b) {
    allowance.push_back(travel_allowance(model, b, extent_of(model, state, b), dt, steps));
  }
  return allowance;
}

std::vector<Box> swept_boxes(const model::Model& model, const model::State& state,
                             const std::vector<double>& allowance) {
  std::vector<Box> boxes;
  for (Index b = 0; b < model.body_count(); ++b) {
    boxes.push_back(swept_box(extent_of(model, state, b), allowance[at(b)]));
  }
  return boxes;
}

TEST(swept_boxes, a_box_is_that_of_the_nodes_and_the_allowance_and_the_reach_of_contact) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "low", square_plate(1.0, 2));
  test::add_body(d, "high", square_plate(2.0, 2)).translate = {0.0, 0.0, 5.0};
  const model::Model model = test::build(d);
  const std::vector<double> allowance{0.25, 0.5};
  const std::vector<Box> boxes = swept_boxes(model, model::initial_state(model), allowance);
  ASSERT_EQ(boxes.size(), 2U);
  for (std::size_t b = 0; b < 2; ++b) {
    double reach = 0.0;
    for (Index n = model.bodies[b].nodes.begin; n < model.bodies[b].nodes.end; ++n) {
      reach = std::max(reach, model.half_thickness[at(n)] + model::watch_margin(model.node_size[at(n)]));
    }
    EXPECT_GT(reach, 0.01);
    const double side = b == 0 ? 1.0 : 2.0, z = b == 0 ? 0.0 : 5.0, grown = allowance[b] + reach;
    EXPECT_EQ(boxes[b].low, (Vec3d{-grown, -grown, z - grown}));
    EXPECT_EQ(boxes[b].high, (Vec3d{side + grown, side + grown, z + grown}));
  }
}

TEST(swept_boxes, the_allowance_covers_steady_flight_and_barriers_get_none) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "flying", square_plate(1.0, 2)).velocity = {3.0, 0.0, 4.0};
  test::add_body(d, "wall", square_plate(1.0, 2)).translate = {0.0, 0.0, -3.0};
  test::add_box_set(d, "wall", {-1.0, -1.0, -4.0}, {2.0, 2.0, -2.0});
  test::fix(d, "wall", {"x", "y", "z", "rx", "ry", "rz"});
  const model::Model model = test::build(d);
  const std::vector<double> allowance = travel_allowance(model, model::initial_state(model), 1.0e-3, 100);
  EXPECT_GE(allowance[0], 5.0 * 0.1);
  EXPECT_LE(allowance[0], 2.0 * 5.0 * 0.1);
  EXPECT_EQ(allowance[1], 0.0);
}

/// A plate that starts at random velocities and is pulled about by random forces, some of them strong.
model::Model restless_plate(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const double strength = std::pow(10.0, 2.0 * number(random));
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", square_plate(1.0, 3)).velocity = {number(random), number(random), number(random)};
  for (int i = 0; i < 4; ++i) {
    const std::string set = "corner " + std::to_string(i);
    const double x = i % 2, y = i / 2;
    test::add_box_set(d, set, {x - 0.1, y - 0.1, -1.0}, {x + 0.1, y + 0.1, 1.0});
    const Vec3d direction{number(random), number(random), number(random)};
    d.forces.push_back({set, (200.0 * strength) * direction, {}, false, "", {}});
  }
  return test::build(d);
}

TEST(swept_boxes, no_node_leaves_its_box_unless_the_guard_trips) {
  constexpr Index steps = 24;
  int tripped = 0, passed = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const model::Model model = restless_plate(seed);
    const double dt = 0.5 * model.first_critical_step;
    solve::Workspace workspace(model, solve::select_element_kernel(solve::KernelChoice::automatic));
    for (Index n = 1; n <= steps; ++n) {
      model::State state = model::initial_state(model);
      solve::IslandSolver island;
      island.assign(model, workspace.patches, state, std::vector<Index>{0}, {});
      island.evaluate(model, state, workspace);
      const std::vector<double> allowance = travel_allowance(model, state, dt, steps);
      Box box;
      for (const model::NodeMotion& motion : state.motion) {
        box.include(motion.position);
      }
      box = box.grown(allowance[0]);
      std::vector<solve::HashRecord> hashes;
      const auto report = island.advance(model, state, workspace,
                                         {dt, n, static_cast<double>(n) * dt, 0, allowance, model.run.damping}, hashes);
      if (report.stop == solve::StopReason::left_swept_box) {
        EXPECT_EQ(report.stop_body, 0);
        EXPECT_GT(report.steps_done, 0) << "one step never leaves the box";
        ++tripped;
        break;
      }
      for (const model::NodeMotion& motion : state.motion) {
        ASSERT_TRUE(box.contains(motion.position)) << "seed " << seed << " step " << n;
      }
      passed += n == steps ? 1 : 0;
    }
  }
  // Otherwise the test would prove nothing.
  EXPECT_GT(tripped, 15);
  EXPECT_GT(passed, 15);
}

TEST(swept_boxes, prescribed_motion_is_allowed_for_before_it_begins) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "driven", square_plate(1.0, 2));
  d.curves.push_back({"later", {{0.0, 0.0}, {0.01, 0.0}, {0.02, -2.0}}, {}});
  for (const char* dof : {"x", "y", "z"}) {
    d.prescribed.push_back({"all", dof, 5.0, "later", {}});
  }
  const model::Model model = test::build(d);
  const std::vector<double> allowance = travel_allowance(model, model::initial_state(model), 1.0e-3, 50);
  EXPECT_GE(allowance[0], std::sqrt(3.0) * 10.0 * 0.05);
}

}  // namespace
}  // namespace fexp::cluster
