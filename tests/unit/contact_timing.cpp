// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "cluster/simulation.hpp"
#include "support/contact.hpp"
#include "support/models.hpp"

/// Contact is a function of positions, velocities and remembered sides at a step boundary: it does not matter when
/// searches happen, with whom a body shares its island, or that a run was cut.
namespace fexp {
namespace {

/// Two spheres of unlike meshes that fly into a thin sheet, which folds over them; a fixed plate stands in the way.
model::Description crash(double speed) {
  auto d = test::description(test::rubber, 0.01);
  d.sections.push_back({"thick", "m", 0.12, {}});
  d.contact.enabled = true;
  d.run.energy_drift_limit = 1.0e6;
  test::add_body(d, "sheet", test::plate(1.6, 1.6, 10, 10)).translate = {-0.8, -0.8, 0.0};
  test::add_body(d, "ball", model::CubedSphere{0.3, 3}).translate = {0.03, 0.02, 0.36};
  d.bodies.back().velocity = {0.1 * speed, 0.0, -speed};
  test::add_body(d, "thick ball", model::UvSphere{0.25, 8, 6}).translate = {0.35, 0.3, -0.36};
  d.bodies.back().velocity = {-0.2 * speed, 0.0, speed};
  d.bodies.back().section = "thick";
  test::add_body(d, "wall", test::plate(2.0, 2.0, 3, 3)).translate = {-1.0, -1.0, -0.75};
  test::add_box_set(d, "wall", {-2.0, -2.0, -0.8}, {2.0, 2.0, -0.7});
  test::fix(d, "wall", {"x", "y", "z", "rx", "ry", "rz"});
  return d;
}

TEST(contact_timing, a_search_before_every_step_from_the_stored_sides_changes_no_bit) {
  for (const double speed : {3.0, 9.0}) {
    const model::Model model = test::build(crash(speed));
    const double dt = 0.5 * model.first_critical_step;
    test::DirectRun run(model);
    test::Contact twin(model, run.state);
    test::Contact seldom(model, run.state);
    seldom.evaluate(model, run.state, 0.0);
    seldom.island.store_sides(model, run.state);
    Index active = 0, searches = 0;
    for (int i = 0; i < 400; ++i) {
      const model::State before = run.state;
      run.advance(dt, 1);
      // The velocity in the middle of the step, which led to the present positions.
      model::State middle = run.state;
      double way = 0.0;
      for (std::size_t n = 0; n < middle.motion.size(); ++n) {
        middle.motion[n].velocity = before.motion[n].velocity + (0.5 * dt) * before.acceleration[n].linear;
        way = std::max(way, norm(middle.motion[n].velocity) * dt);
      }
      model::State one = before, two = before;
      seldom.island.store_sides(model, one);
      twin.assign(model, one);
      const contact::ContactReport report_twin = twin.evaluate(model, middle, dt);
      seldom.island.advance(model, middle, way);
      const contact::ContactReport report = seldom.evaluate(model, middle, dt);
      twin.island.store_sides(model, one);
      seldom.island.store_sides(model, two);
      ASSERT_EQ(one.sides, two.sides) << "step " << i;
      ASSERT_EQ(one.edge_sides, two.edge_sides) << "step " << i;
      ASSERT_EQ(report.active_pairs, report_twin.active_pairs);
      ASSERT_EQ(report.max_stiffness_over_mass, report_twin.max_stiffness_over_mass);
      ASSERT_EQ(seldom.nodes.force, twin.nodes.force) << "step " << i;
      ASSERT_EQ(seldom.nodes.stiffness, twin.nodes.stiffness);
      for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        ASSERT_EQ(seldom.bodies[b].energy, twin.bodies[b].energy);
        ASSERT_EQ(seldom.bodies[b].barrier_force, twin.bodies[b].barrier_force);
      }
      active = std::max(active, report.active_pairs);
      searches = report.searches;
    }
    EXPECT_GT(active, 20);
    EXPECT_LT(searches, 300);
  }
}

TEST(contact_timing, looking_again_without_a_step_gives_the_same_sides_forces_and_energies) {
  for (const double speed : {3.0, 9.0}) {
    const model::Model model = test::build(crash(speed));
    test::DirectRun run(model);
    int through = 0;
    for (int i = 0; i < 300; ++i) {
      run.advance(0.5 * model.first_critical_step, 1);
      model::State again = run.state;
      run.store();
      again.sides = run.state.sides;
      again.edge_sides = run.state.edge_sides;
      test::Contact contact(model, again);
      contact.evaluate(model, again, 0.0);
      contact.island.store_sides(model, again);
      ASSERT_EQ(again.sides, run.state.sides) << "step " << i;
      ASSERT_EQ(again.edge_sides, run.state.edge_sides) << "step " << i;
      ASSERT_EQ(contact.nodes.force, run.workspace.contact.force) << "step " << i;
      for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        ASSERT_EQ(contact.bodies[b].energy, run.workspace.body_contact[b].energy);
      }
      for (const auto& sides : again.sides) {
        for (const model::ContactSide& s : sides) {
          const contact::Positions x{again.motion.data(), 0.0};
          contact::Normals normals(model, x);
          through +=
              contact::view_of(model, normals, s.element, contact::closest_on(model, x, s.element, x(s.node))).side !=
              s.side;
        }
      }
    }
    // The hard case is there: nodes that have come through.
    EXPECT_GT(through, 100) << speed;
  }
}

TEST(contact_timing, a_run_that_is_cut_and_taken_up_from_its_state_at_any_step_goes_on_bit_for_bit) {
  const model::Model model = test::build(crash(9.0));
  const double dt = 0.5 * model.first_critical_step;
  test::DirectRun whole(model);
  auto cut = std::make_unique<test::DirectRun>(model);
  for (int i = 0; i < 200; ++i) {
    whole.advance(dt, 1);
    cut->advance(dt, 1);
    cut->store();
    const model::State kept = cut->state;
    cut = std::make_unique<test::DirectRun>(model, kept);
    whole.store();
    ASSERT_EQ(model::state_hash(model, cut->state), model::state_hash(model, whole.state)) << "step " << i;
  }
}

TEST(contact_timing, an_island_gains_nothing_from_bodies_that_it_does_not_touch) {
  auto d = crash(9.0);
  const auto add_far_pair = [&] {
    test::add_body(d, "far", test::plate(1.0, 1.0, 4, 4)).translate = {50.0, 0.0, 0.0};
    test::add_body(d, "farther", model::CubedSphere{0.3, 2}).translate = {50.5, 0.5, 0.35};
    d.bodies.back().velocity = {0.0, 0.0, -9.0};
  };
  const model::Model alone = test::build(d);
  add_far_pair();
  const model::Model merged = test::build(d);
  test::DirectRun one(alone), two(merged);
  const double dt = 0.5 * alone.first_critical_step;
  for (int i = 0; i < 40; ++i) {
    one.advance(dt, 5);
    two.advance(dt, 5);
    one.store();
    two.store();
    for (Index b = 0; b < alone.body_count(); ++b) {
      ASSERT_EQ(model::body_hash(alone, one.state, b), model::body_hash(merged, two.state, b)) << i << " body " << b;
    }
  }
}

TEST(contact_timing, bodies_that_remember_sides_of_each_other_share_an_island_however_deep_one_has_come_through) {
  // A stiff, heavy, coarse plate is shot through a light one; it is wholly on the other side before it is forgotten.
  auto d = test::description(test::rubber, 0.002);
  d.materials.push_back({"lead", {physics::LinearElastic{2.0e5, 1.0e7, 0.3}}, {}});
  d.sections.push_back({"heavy", "lead", 0.002, {}});
  d.contact.enabled = true;
  d.contact.self = false;
  d.contact.penalty_scale = 1e-3;
  d.contact.hardening = 0.0;
  d.run.energy_drift_limit = 1.0e6;
  d.run.epoch_steps = 2;
  test::add_body(d, "light", test::plate(3.0, 3.0, 3, 3)).translate = {-1.5, -1.5, 0.0};
  test::add_body(d, "heavy", test::plate(1.0, 1.0, 2, 2)).translate = {-0.45, -0.4, 0.05};
  d.bodies.back().section = "heavy";
  d.bodies.back().velocity = {0.0, 0.0, -0.5};
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  int apart = 0, joined_by_memory = 0;
  for (int i = 0; i < 400; ++i) {
    simulation.run_epoch(1.0e9);
    const model::State& state = simulation.state();
    bool remembered = false;
    for (Index b = 0; b < model.body_count(); ++b) {
      for (const model::ContactSide& s : state.sides[at(b)]) {
        remembered = remembered || model.node_body[at(s.node)] != contact::body_of_element(model, s.element);
      }
    }
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (Index n = 0; n < model.bodies[0].nodes.end; ++n) {
      low = std::min(low, state.motion[at(n)].position.z);
    }
    for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
      high = std::max(high, state.motion[at(n)].position.z);
    }
    simulation.run_epoch(1.0e9);
    const bool same = simulation.island_of_body()[0] == simulation.island_of_body()[1];
    EXPECT_TRUE(same || !remembered);
    joined_by_memory += remembered && low - high > 0.25;
    apart += !same;
  }
  EXPECT_GT(joined_by_memory, 0);
  EXPECT_GT(apart, 0);
}

}  // namespace
}  // namespace fexp
