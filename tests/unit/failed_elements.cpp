// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contact/surface.hpp"
#include "model/capture.hpp"
#include "solve/diagnostics.hpp"
#include "solve/loads.hpp"
#include "support/contact.hpp"
#include "support/kernels.hpp"
#include "support/layered.hpp"
#include "support/models.hpp"

/// What becomes of elements whose points have all reached the failure strain.
namespace fexp {
namespace {

physics::J2Linear brittle() { return {{7850.0, 200e9, 0.3, 0.0, 1.0, 0.02}, 250e6, 2e9}; }

physics::ShellIncrement<double> pull(double strain) {
  return {strain, -0.3 * strain, 0.0, 0.0, 0.0, 0.0, 0.1 * strain, 0.0, {0.1 * strain, 0.0, 0.0}};
}

TEST(failed_elements, carry_nothing_once_all_points_have_failed) {
  test::LayeredDriver<physics::J2Linear> element(brittle(), 0.01, 2);
  for (int i = 0; i < 200 && element.row(physics::layer_deleted) == 0.0; ++i) {
    EXPECT_LT(element.row(physics::layer_points + int{physics::point_strain}), 0.02);
    element.step(pull(2e-4));
  }
  EXPECT_EQ(element.row(physics::layer_deleted), 1.0);
  EXPECT_GE(element.row(physics::layer_points + int{physics::point_strain}), 0.02);
  const double energy = element.resultants.energy, thickness = element.row(physics::layer_thickness);
  const double dissipation = element.row(physics::layer_dissipation);
  EXPECT_GT(dissipation, 0.9 * energy);
  EXPECT_LT(dissipation, energy);
  for (int i = 0; i < 3; ++i) {
    const physics::ShellResultants<double>& s = element.resultants;
    for (const double value : {s.nxx, s.nyy, s.nxy, s.mxx, s.myy, s.mxy, s.qxz, s.qyz, s.drill[0]}) {
      EXPECT_EQ(value, 0.0);
    }
    EXPECT_EQ(s.energy, energy);
    EXPECT_EQ(element.row(physics::layer_thickness), thickness);
    EXPECT_EQ(element.row(physics::layer_dissipation), dissipation);
    element.step(pull(i == 0 ? 0.3 : std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(element.row(physics::layer_deleted), 2.0);
  }
}

/// In bending the outer points fail first: the element goes on with the inner one.
TEST(failed_elements, are_not_deleted_while_a_point_is_left) {
  test::LayeredDriver<physics::J2Linear> element(brittle(), 0.01, 3);
  for (int i = 0; i < 100; ++i) {
    element.step({1e-5, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, {}});
  }
  const auto strain = [&](int point) {
    return element.row(physics::layer_points + point * physics::point_rows + physics::point_strain);
  };
  EXPECT_GE(strain(0), 0.02);
  EXPECT_LT(strain(1), 0.02);
  EXPECT_GE(strain(2), 0.02);
  EXPECT_EQ(element.row(physics::layer_deleted), 0.0);
  EXPECT_GT(element.resultants.nxx, 0.0);
  EXPECT_NEAR(element.resultants.mxx, 0.0, 1e-9 * element.resultants.nxx);
}

/// A plate of 2 x 2 cells of a material that can fail, and a ball that can touch it.
model::Model plate_and_ball() {
  auto d = test::description({7850.0, 200e9, 0.3}, 0.01);
  d.materials[0].law = brittle();
  d.sections[0].points = 2;
  d.contact.enabled = true;
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 2, 2, "one"});
  test::add_body(d, "ball", model::CubedSphere{0.2, 2}).translate = {0.5, 0.5, 0.205};
  d.pressure.push_back({{"plate"}, "", 3.0, "", {}});
  return test::build(d);
}

double& deleted(const model::Model& model, model::State& state, Index element) {
  const model::ElementBlock& block = model.blocks[at(model.element_block[at(element)])];
  return state
      .layers[(at(block.layer_row) + physics::layer_deleted) * at(model::block_lanes) + at(element - block.first)];
}

TEST(failed_elements, exert_no_force_whatever_became_of_their_geometry) {
  const model::Model model = plate_and_ball();
  for (const solve::SelectedKernel& kernel : test::kernels_here()) {
    for (const double dt : {0.0, 1e-6}) {
      model::State state = model::initial_state(model);
      for (Index e = 0; e < model.element_count(); ++e) {
        deleted(model, state, e) = 2.0;
      }
      state.motion[0].position.x = std::numeric_limits<double>::quiet_NaN();
      state.motion[1].position = state.motion[4].position;
      solve::Workspace workspace(model, kernel);
      const solve::Patch& patch = workspace.patches.patches[0];
      AlignedVector<solve::NodeForce> force(at(patch.force_count()));
      kernel.elements({state.motion.data(), model.triangle.data(), model.blocks.data(), workspace.sections.data(),
                       state.history.data(), workspace.patches.corner.data(), force.data(), dt, model.sections.data(),
                       state.layers.data()},
                      patch.blocks.begin, patch.blocks.end);
      for (const solve::NodeForce& f : force) {
        EXPECT_EQ(f.force, Vec3d{});
        EXPECT_EQ(f.moment, Vec3d{});
      }
    }
  }
}

TEST(failed_elements, limit_no_step_and_are_counted) {
  const model::Model model = plate_and_ball();
  model::State state = model::initial_state(model);
  const solve::CriticalStep all = solve::body_critical_step(model, state, 0);
  // The one that limits the step, made smaller still.
  state.motion[at(model.triangle[at(all.element)][1])].position +=
      0.5 * (model.reference_position[at(model.triangle[at(all.element)][0])] -
             model.reference_position[at(model.triangle[at(all.element)][1])]);
  const solve::CriticalStep smaller = solve::body_critical_step(model, state, 0);
  EXPECT_LT(smaller.step, 0.9 * all.step);
  deleted(model, state, smaller.element) = 1.0;
  EXPECT_GT(solve::body_critical_step(model, state, 0).step, smaller.step);
  EXPECT_EQ(solve::body_diagnostics(model, state, 0).deleted, 1);
  EXPECT_EQ(solve::diagnostics(model, state).deleted, 1);
  const model::Frame frame = model::capture(model, state, {}, {});
  EXPECT_EQ(std::count(frame.deleted.begin(), frame.deleted.end(), 1), 1);
  EXPECT_EQ(frame.deleted[at(smaller.element)], 1);
}

/// Loads and contact come before the elements in a step: looked at again without a step, those that failed at its end
/// are still there.
TEST(failed_elements, are_pressed_until_the_end_of_their_last_step) {
  const model::Model model = plate_and_ball();
  model::State state = model::initial_state(model);
  const auto pressed = [&](bool still) {
    std::vector<solve::NodalAction> load(at(model.node_count()));
    solve::evaluate_loads(model, state.motion.data(), state.layers.data(), still, 0.0, 0, load.data());
    double sum = 0.0;
    for (const solve::NodalAction& action : load) {
      sum -= action.force.z;
    }
    return sum;
  };
  EXPECT_NEAR(pressed(true), 3.0, 1e-12);
  deleted(model, state, 0) = 1.0;
  EXPECT_NEAR(pressed(true), 3.0, 1e-12);
  EXPECT_NEAR(pressed(false), 3.0 * 7.0 / 8.0, 1e-12);
  deleted(model, state, 0) = 2.0;
  EXPECT_NEAR(pressed(true), 3.0 * 7.0 / 8.0, 1e-12);
}

TEST(failed_elements, are_touched_no_more_and_leave_a_rim) {
  const model::Model model = plate_and_ball();
  ASSERT_TRUE(model.can_fail);
  model::State state = model::initial_state(model);
  // Nothing pushes as it was built.
  for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
    state.motion[at(n)].position.z -= 0.002;
  }
  test::Contact contact(model, state);
  EXPECT_GT(contact.evaluate(model, state, 0.0).active_pairs, 0);
  for (Index e = 0; e < 8; ++e) {
    deleted(model, state, e) = 1.0;
  }
  EXPECT_GT(contact.evaluate(model, state, 0.0).active_pairs, 0) << "they failed at the end of this step";
  EXPECT_EQ(contact.evaluate(model, state, 1e-6).active_pairs, 0);
  contact.assign(model, state);
  EXPECT_EQ(contact.evaluate(model, state, 1e-6).active_pairs, 0) << "nor with a search of its own";

  // The middle of the plate lies inside, until one of the elements round it is gone.
  Index middle = 0;
  while (norm(model.reference_position[at(middle)] - Vec3d{0.5, 0.5, 0.0}) > 1e-9) {
    ++middle;
  }
  std::vector<Index> round;
  for (Index c = model.corner_start[at(middle)]; c < model.corner_start[at(middle) + 1]; ++c) {
    round.push_back(model.corner[at(c)] / 3);
  }
  const auto is_rim = [&] {
    const contact::Positions x{state.motion.data(), 0.0, state.layers.data(), false};
    const auto& t = model.triangle[at(round[0])];
    const auto closest = contact::closest_on(model, x, round[0], model.reference_position[at(middle)]);
    EXPECT_EQ(t[physics::number_of(closest.feature)], middle);
    return contact::is_on_rim(model, x, round[0], closest.feature);
  };
  for (Index e = 0; e < 8; ++e) {
    deleted(model, state, e) = 0.0;
  }
  EXPECT_FALSE(is_rim());
  deleted(model, state, round.back()) = 2.0;
  EXPECT_TRUE(is_rim());
}

/// A sheet that is torn apart keeps its mass and momentum, and the energies balance throughout.
TEST(failed_elements, leave_energy_and_momentum_in_balance) {
  auto d = test::description({7850.0, 200e9, 0.3}, 0.01);
  d.materials[0].law = brittle();
  d.sections[0].points = 2;
  test::add_body(d, "sheet", model::Plate{1.0, 0.5, 10, 5, "one"});
  model::Model model = test::build(d);
  for (std::size_t n = 0; n < model.initial_velocity.size(); ++n) {
    const double x = model.reference_position[n].x - 0.5;
    model.initial_velocity[n] = {x > 0.0 ? 40.0 : -40.0, 3.0, 10.0 * x};
  }
  test::DirectRun run(model);
  const solve::Diagnostics start = solve::diagnostics(model, run.state);
  for (int i = 0; i < 30; ++i) {
    run.advance(0.5 * model.first_critical_step, 10);
    const solve::Diagnostics now = solve::diagnostics(model, run.state);
    ASSERT_NEAR(now.energies.balance(), start.energies.kinetic, 2e-3 * start.energies.kinetic);
    ASSERT_LT(norm(now.momenta.linear - start.momenta.linear), 1e-12 * start.momenta.linear_scale);
    ASSERT_LT(norm(now.momenta.angular - start.momenta.angular), 1e-12 * start.momenta.angular_scale);
  }
  const solve::Diagnostics end = solve::diagnostics(model, run.state);
  EXPECT_GT(end.deleted, 5);
  EXPECT_LT(end.deleted, model.element_count());
  EXPECT_GT(end.energies.dissipated, 0.05 * start.energies.kinetic);
}

}  // namespace
}  // namespace fexp
