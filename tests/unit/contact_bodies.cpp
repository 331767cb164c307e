// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "cluster/simulation.hpp"
#include "support/contact.hpp"
#include "support/models.hpp"

/// Forces of whole bodies on each other, on themselves and on barriers, and what the deck's settings do to them.
namespace fexp {
namespace {

model::Description shells(double thickness) {
  auto d = test::description(test::rubber, thickness);
  d.contact.enabled = true;
  return d;
}

/// A sphere pressed into a plate.
model::Description pressed() {
  auto d = shells(0.1);
  test::add_body(d, "plate", test::plate(2.0, 2.0, 6, 6)).translate = {-1.0, -1.0, 0.0};
  test::add_body(d, "ball", model::CubedSphere{0.5, 4}).translate = {0.03, 0.02, 0.62};
  return d;
}

/// The state in which the ball has come down by `depth`, and its contact.
contact::ContactReport press(const model::Model& model, double depth, test::Contact& contact) {
  model::State state = model::initial_state(model);
  contact.assign(model, state);
  contact.evaluate(model, state, 0.0);
  for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
    state.motion[at(n)].position.z -= depth;
    state.motion[at(n)].velocity.z = -depth;
  }
  contact.island.advance(model, state, depth);
  return contact.evaluate(model, state, 1.0);
}

TEST(contact_bodies, forces_and_their_moments_sum_to_nothing) {
  const model::Model model = test::build(pressed());
  test::Contact contact(model, model::initial_state(model));
  EXPECT_GT(press(model, 0.06, contact).active_pairs, 2);
  Vec3d sum, moment;
  double moduli = 0.0;
  for (Index n = 0; n < model.node_count(); ++n) {
    Vec3d x = model.reference_position[at(n)];
    x.z -= n >= model.bodies[1].nodes.begin ? 0.06 : 0.0;
    sum += contact.nodes.force[at(n)];
    moment += cross(x, contact.nodes.force[at(n)]);
    moduli += norm(contact.nodes.force[at(n)]);
  }
  EXPECT_GT(moduli, 0.0);
  EXPECT_LE(norm(sum), 1e-15 * moduli);
  EXPECT_LE(norm(moment), 1e-14 * moduli);
}

TEST(contact_bodies, are_left_alone_where_the_deck_says_so) {
  const auto pairs = [](const model::Description& d) {
    const model::Model model = test::build(d);
    test::Contact contact(model, model::initial_state(model));
    return press(model, 0.06, contact).active_pairs;
  };
  EXPECT_GT(pairs(pressed()), 0);
  auto d = pressed();
  d.contact.exclude.push_back({"ball", "plate"});
  EXPECT_EQ(pairs(d), 0);
  d = pressed();
  d.contact.enabled = false;
  EXPECT_EQ(pairs(d), 0);
  d = pressed();
  d.contact.self = false;
  EXPECT_EQ(pairs(d), pairs(pressed()));
}

TEST(contact_bodies, touch_themselves_unless_the_deck_says_otherwise) {
  auto d = shells(0.02);
  test::add_body(d, "box", model::OpenBox{1.0, 1.0, 1.0, 4, 4, 4});
  const auto pairs = [](const model::Description& description) {
    const model::Model model = test::build(description);
    model::State state = model::initial_state(model);
    test::Contact contact(model, state);
    contact.evaluate(model, state, 0.0);
    // The walls at both ends of x come close to each other.
    double way = 0.0;
    for (model::NodeMotion& m : state.motion) {
      const double before = m.position.x;
      m.position.x *= 0.01;
      m.velocity = {m.position.x - before, 0.0, 0.0};
      way = std::max(way, norm(m.velocity));
    }
    contact.island.advance(model, state, way);
    return contact.evaluate(model, state, 1.0).active_pairs;
  };
  EXPECT_GT(pairs(d), 20);
  auto alone = d;
  alone.contact.self = false;
  EXPECT_EQ(pairs(alone), 0);
  alone = d;
  alone.contact.exclude.push_back({"box", "box"});
  EXPECT_EQ(pairs(alone), 0);
}

TEST(contact_bodies, feel_the_stiffness_that_the_deck_gives) {
  auto d = pressed();
  d.contact.stiffness = 1234.0;
  const model::Model model = test::build(d);
  test::Contact contact(model, model::initial_state(model));
  const auto report = press(model, 0.06, contact);
  double sum = 0.0;
  for (const double k : contact.nodes.stiffness) {
    sum += k;
  }
  // Each pair counts once at its node and once in all at the corners.
  EXPECT_NEAR(sum, 2.0 * 1234.0 * report.active_pairs, 1e-9 * sum);
}

TEST(contact_bodies, push_nothing_in_the_mesh_as_it_was_built_however_thick_near_or_crossed) {
  for (const double thickness : {0.01, 0.3, 0.6}) {
    auto d = shells(thickness);
    test::add_body(d, "plate", test::plate(2.0, 2.0, 10, 10));
    test::add_body(d, "crossing", test::plate(2.0, 2.0, 7, 7))
        .rotate.push_back({{1.0, 0.0, 0.0}, 80.0, {0.0, 1.03, 0.0}});
    test::add_body(d, "touching", test::plate(2.0, 2.0, 8, 8, "crossed")).translate = {0.1, 0.1, 0.3 * thickness};
    test::add_body(d, "ball", model::CubedSphere{0.5, 4}).translate = {0.4, 0.4, 0.3};
    test::add_body(d, "box", model::OpenBox{1.0, 0.6, 0.5, 8, 8, 8}).translate = {1.0, 1.0, 0.1};
    const model::Model model = test::build(d);
    const model::State state = model::initial_state(model);
    test::Contact contact(model, state);
    const auto report = contact.evaluate(model, state, 0.0);
    EXPECT_EQ(report.active_pairs, 0) << thickness;
    EXPECT_EQ(contact.energy(), 0.0);
    EXPECT_GT(report.candidates, 1000);
  }
}

TEST(contact_bodies, get_from_barriers_on_either_side_of_a_pair_the_impulse_that_is_booked) {
  for (const int cells : {2, 24}) {  // coarse: the ball's nodes push; fine: the barrier's nodes do as well
    auto d = shells(0.05);
    d.run.epoch_steps = 4;
    test::add_body(d, "wall", test::plate(2.0, 2.0, cells, cells)).translate = {-1.0, -1.0, 0.0};
    test::add_body(d, "ball", model::CubedSphere{0.5, 2}).translate = {0.13, 0.07, 0.6};
    d.bodies.back().velocity = {0.5, 0.2, -3.0};
    test::add_box_set(d, "wall", {-1.0, -1.0, -0.01}, {1.0, 1.0, 0.01});
    d.node_sets.back().bodies = {"wall"};
    test::fix(d, "wall", {"x", "y", "z", "rx", "ry", "rz"});
    const model::Model model = test::build(d);
    ASSERT_TRUE(model.bodies[0].barrier);
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    while (simulation.state().time < 0.3) {
      const auto report = simulation.run_epoch(0.3);
      ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    }
    const auto& x = simulation.extremes();
    EXPECT_GT(x.most_active_pairs, 0);
    EXPECT_LE(x.linear_momentum_error, 1e-12);
    EXPECT_LE(x.angular_momentum_error, 1e-12);
    EXPECT_LE(x.energy_error, 0.01);
    EXPECT_GT(simulation.present().diagnostics.momenta.external_impulse.z, 0.0);
    for (Index n = 0; n < model.bodies[0].nodes.end; ++n) {
      EXPECT_EQ(simulation.state().motion[at(n)].position, model.reference_position[at(n)]);
    }
  }
}

}  // namespace
}  // namespace fexp
