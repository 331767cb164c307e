// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "model/added_mass.hpp"
#include "model/body_properties.hpp"
#include "model/element_shares.hpp"
#include "quality/assess.hpp"
#include "solve/diagnostics.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using test::rubber;

/// A plate of 10 x 10 cells, with a strip of much finer cells as another body.
model::Description coarse_and_fine() {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "coarse", model::Plate{1.0, 1.0, 10, 10, "one"});
  test::add_body(d, "fine", model::Plate{0.1, 0.1, 5, 5, "one"}).translate = {2.0, 0.0, 0.0};
  return d;
}

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(mass_scaling, gives_short_elements_just_the_mass_that_the_step_takes) {
  auto d = coarse_and_fine();
  const model::Model plain = test::build(d);
  EXPECT_TRUE(plain.step_factor.empty());
  d.run.minimum_step = 2.0 * d.run.safety * plain.first_critical_step;
  const model::Model scaled = test::build(d);
  EXPECT_NEAR(scaled.run.safety * scaled.first_critical_step, d.run.minimum_step, 1e-14 * d.run.minimum_step);
  // The coarse body needs none; each element of the fine one may get another factor.
  const std::vector<double> step = model::element_shares(plain).step;
  double added = 0.0;
  for (Index e = 0; e < plain.element_count(); ++e) {
    const double factor = std::max(1.0, 2.0 * plain.first_critical_step / step[at(e)]);
    EXPECT_NEAR(scaled.step_factor[at(e)], factor, 1e-14);
    added += (factor * factor - 1.0) * 1000.0 * 0.02 * plain.reference_area[at(e)];
  }
  EXPECT_NEAR(total(scaled.mass), total(plain.mass) + added, 1e-12 * total(plain.mass));
  EXPECT_EQ(scaled.bodies[0].mass, plain.bodies[0].mass);
  EXPECT_EQ(std::vector<double>(scaled.inertia.begin(), scaled.inertia.begin() + plain.bodies[0].nodes.end),
            std::vector<double>(plain.inertia.begin(), plain.inertia.begin() + plain.bodies[0].nodes.end));
  EXPECT_NEAR(model::body_properties(scaled, 1).mass, scaled.bodies[1].mass, 1e-12 * scaled.bodies[1].mass);

  const std::vector<model::AddedMass> parts = model::added_masses(scaled);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].body, "fine");
  EXPECT_EQ(parts[0].part, "shell");
  EXPECT_EQ(parts[0].elements, 50);
  EXPECT_NEAR(parts[0].mass, 1000.0 * 0.02 * 0.01, 1e-12);
  EXPECT_NEAR(parts[0].added, added, 1e-12);
}

TEST(mass_scaling, to_a_step_that_is_reached_anyway_changes_nothing) {
  auto d = coarse_and_fine();
  const model::Model plain = test::build(d);
  d.run.minimum_step = 0.999 * d.run.safety * plain.first_critical_step;
  const model::Model same = test::build(d);
  EXPECT_TRUE(same.step_factor.empty());
  EXPECT_TRUE(model::added_masses(same).empty());
  EXPECT_EQ(same.mass, plain.mass);
}

TEST(mass_scaling, is_in_the_critical_step_of_every_kernel) {
  auto d = coarse_and_fine();
  d.run.minimum_step = 3.0 * d.run.safety * test::build(d).first_critical_step;
  const model::Model model = test::build(d);
  const model::State state = model::initial_state(model);
  const double target = d.run.minimum_step / d.run.safety;
  EXPECT_NEAR(solve::body_critical_step(model, state, 1).step, target, 1e-13 * target);
  for (const auto choice : {solve::KernelChoice::scalar, solve::KernelChoice::baseline, solve::KernelChoice::avx2,
                            solve::KernelChoice::avx512}) {
    const solve::SelectedKernel kernel = solve::select_element_kernel(choice);
    if (kernel.elements != nullptr) {
      const solve::CriticalStep step =
          kernel.steps({state.motion.data(), model.triangle.data(), model.blocks.data(), model.sections.data(),
                        model.run.drilling, model.step_factor.data()},
                       model.bodies[1].blocks.begin, model.bodies[1].blocks.end);
      EXPECT_EQ(step.step, solve::body_critical_step(model, state, 1).step) << kernel.name;
    }
  }
}

TEST(mass_scaling, keeps_a_run_at_the_longer_step_stable) {
  auto d = coarse_and_fine();
  d.bodies[1].angular_velocity = {0.0, 0.0, 5.0};
  const double plain_step = test::build(d).first_critical_step;
  d.run.minimum_step = 3.0 * d.run.safety * plain_step;
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double before = solve::diagnostics(model, run.state).energies.kinetic;
  const solve::IslandReport report = run.advance(0.9 * model.first_critical_step, 3000);
  EXPECT_EQ(report.stop, solve::StopReason::none);
  const solve::Energies energies = solve::diagnostics(model, run.state).energies;
  EXPECT_NEAR(energies.balance(), before, 5e-3 * before);
  EXPECT_GT(0.9 * model.first_critical_step, 2.0 * plain_step) << "which would not be stable without the mass";
}

TEST(mass_scaling, is_told_with_a_warning_above_a_twentieth_of_a_part_s_mass) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 10, 10, "one"}).velocity = {1.0, 0.0, 0.0};
  const double step = d.run.safety * test::build(d).first_critical_step;
  const auto finding_at = [&](double share) {
    d.run.minimum_step = std::sqrt(1.0 + share) * step;
    const std::vector<quality::Finding> found = quality::added_mass(test::build(d));
    return found.empty() ? quality::Finding{} : found.front();
  };
  EXPECT_EQ(finding_at(-0.01).count, 0);
  EXPECT_EQ(finding_at(0.049).severity, quality::Severity::note);
  EXPECT_EQ(finding_at(0.051).severity, quality::Severity::warning);
  EXPECT_EQ(finding_at(0.051).count, 200);
  EXPECT_NEAR(finding_at(0.051).numbers[1].second, 0.051 * 20.0, 1e-10);
}

TEST(point_mass, is_on_each_node_or_shared_as_a_total_and_adds_up) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 4, 4, "one"});
  const model::Model plain = test::build(d);
  test::add_box_set(d, "edge", {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  d.point_masses.push_back({"edge", 2.0, 0.5, false, {}});
  d.point_masses.push_back({"all", 50.0, 5.0, true, {}});
  const model::Model model = test::build(d);
  for (Index n = 0; n < model.node_count(); ++n) {
    const double each = model.reference_position[at(n)].x == 0.0 ? 1.0 : 0.0;
    EXPECT_NEAR(model.mass[at(n)], plain.mass[at(n)] + 2.0 * each + 50.0 / 25.0, 1e-13);
    EXPECT_NEAR(model.inertia[at(n)], plain.inertia[at(n)] + 0.5 * each + 5.0 / 25.0, 1e-13);
    EXPECT_NEAR(model.contact_stiffness[at(n)] / plain.contact_stiffness[at(n)], model.mass[at(n)] / plain.mass[at(n)],
                1e-12);
  }
  EXPECT_NEAR(model.bodies[0].mass, plain.bodies[0].mass + 60.0, 1e-11);
  EXPECT_EQ(model.first_critical_step, plain.first_critical_step);
}

TEST(point_mass, moves_the_centre_and_the_inertia_of_its_body) {
  auto d = test::description({1000.0, 1.0e6, 0.4}, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 2, 2, "one"}).angular_velocity = {0.0, 0.0, 2.0};
  test::add_box_set(d, "corner", {1.0, 1.0, 0.0}, {1.0, 1.0, 0.0});
  d.point_masses.push_back({"corner", 20.0, 3.0, false, {}});
  const model::Model model = test::build(d);
  const model::BodyProperties p = model::body_properties(model, 0);
  // A plate of mass 20 about its centre, and 20 at its corner: both are a quarter of the diagonal from the middle.
  EXPECT_NEAR(p.mass, 40.0, 1e-12);
  EXPECT_NEAR(p.centre.x, 0.75, 1e-14);
  const double steiner = 40.0 * 2.0 * 0.25 * 0.25;
  EXPECT_NEAR(p.inertia[2], 20.0 * (1.0 + 1.0) / 12.0 + steiner + 3.0, 1e-12);
  EXPECT_NEAR(p.inertia[0], 20.0 * (1.0 + 0.0004) / 12.0 + 0.5 * steiner + 3.0, 1e-12);
  // The body turns about the centre of all its mass.
  const Vec3d momentum = solve::diagnostics(model, model::initial_state(model)).momenta.linear;
  EXPECT_LT(norm(momentum), 1e-12);
}

TEST(point_mass, falls_as_everything_does) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 3, 3, "one"});
  test::add_box_set(d, "corner", {1.0, 1.0, 0.0}, {1.0, 1.0, 0.0});
  d.point_masses.push_back({"corner", 7.0, 0.0, false, {}});
  d.gravity.push_back({{0.0, 0.0, -10.0}, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const double dt = 0.5 * model.first_critical_step, time = 1000.0 * dt;
  run.advance(dt, 1000);
  for (Index n = 0; n < model.node_count(); ++n) {
    EXPECT_NEAR(run.state.motion[at(n)].position.z, -5.0 * time * time, 1e-10 * 5.0 * time * time);
  }
  const double mass = model.bodies[0].mass;
  EXPECT_NEAR(run.state.ledger[0].external_work, 0.5 * mass * 100.0 * time * time, 1e-9 * mass * 50.0 * time * time);
}

}  // namespace
}  // namespace fexp
