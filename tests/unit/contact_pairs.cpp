// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "solve/diagnostics.hpp"
#include "support/contact.hpp"
#include "support/models.hpp"

/// Settings of contact for single pairs of bodies, and where penalty stiffnesses come from.
namespace fexp {
namespace {

/// A ball that is thrown at an angle on to a plate, and another one that meets nothing.
model::Description thrown() {
  auto d = test::description(test::rubber, 0.05);
  d.contact.enabled = true;
  test::add_body(d, "plate", test::plate(2.0, 2.0, 8, 8)).translate = {-1.0, -1.0, 0.0};
  test::add_body(d, "ball", model::CubedSphere{0.4, 4}).translate = {0.03, 0.02, 0.46};
  d.bodies.back().velocity = {1.0, 0.5, -2.0};
  test::add_body(d, "other", model::CubedSphere{0.4, 4}).translate = {0.0, 0.0, 9.0};
  return d;
}

model::ContactPair pair(const std::string& a, const std::string& b) {
  model::ContactPair p;
  p.bodies = {a, b};
  return p;
}

struct PairOutcome {
  std::uint64_t hash{};
  double friction{};
  double deepest{};
};

PairOutcome run(const model::Description& d) {
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  const solve::IslandReport report = run.advance(0.2 * model.first_critical_step, 600);
  EXPECT_GT(report.most_active_pairs, 0);
  run.store();
  return {model::state_hash(model, run.state), solve::diagnostics(model, run.state).energies.friction, report.deepest};
}

TEST(contact_pairs, have_the_laws_that_the_deck_gives_them_and_others_have_those_of_all) {
  auto d = test::description(test::rubber, 0.05);
  d.contact.friction = 0.1;
  d.contact.damping = 0.2;
  d.contact.penalty_scale = 4.0;
  for (const char* name : {"a", "b", "c"}) {
    test::add_body(d, name, model::CubedSphere{0.4, 2});
  }
  d.bodies[0].array = model::Array{{2, 1, 1}, {3.0, 0.0, 0.0}};
  d.bodies[1].translate.y = 3.0;
  d.bodies[2].translate.y = 6.0;
  model::Model model = test::build(d);
  EXPECT_TRUE(model.contact_laws.group.empty());
  EXPECT_TRUE(model.contact_laws.drags);
  EXPECT_EQ(model.contact_laws.of(0, 3).drag.friction, 0.1);
  EXPECT_EQ(model.contact_laws.of(0, 3).scale, 1.0);

  d.contact.pairs = {pair("b", "a"), pair("a", "a"), pair("a[1,0,0]", "c")};
  d.contact.pairs[0].friction = 0.5;
  d.contact.pairs[1].penalty_scale = 2.0;
  d.contact.pairs[1].damping = 0.0;
  d.contact.pairs[2].stiffness = 77.0;
  model = test::build(d);
  ASSERT_EQ(model.bodies[1].name, "a[1,0,0]");
  const auto expect = [&](Index a, Index b, double friction, double damping, double stiffness, double scale) {
    for (const model::ContactLaw& law : {model.contact_laws.of(a, b), model.contact_laws.of(b, a)}) {
      EXPECT_EQ(law.drag.friction, friction) << a << " " << b;
      EXPECT_EQ(law.drag.damping, damping) << a << " " << b;
      EXPECT_EQ(law.stiffness, stiffness) << a << " " << b;
      EXPECT_EQ(law.scale, scale) << a << " " << b;
    }
  };
  expect(0, 2, 0.5, 0.2, -1.0, 1.0);
  expect(1, 2, 0.5, 0.2, -1.0, 1.0);
  expect(0, 0, 0.1, 0.0, -1.0, 0.5);
  expect(0, 1, 0.1, 0.0, -1.0, 0.5);
  expect(1, 1, 0.1, 0.0, -1.0, 0.5);
  expect(1, 3, 0.1, 0.2, 77.0, 1.0);
  expect(0, 3, 0.1, 0.2, -1.0, 1.0);
  expect(2, 2, 0.1, 0.2, -1.0, 1.0);
  expect(2, 3, 0.1, 0.2, -1.0, 1.0);
  d.contact.friction = d.contact.damping = 0.0;
  EXPECT_TRUE(test::build(d).contact_laws.drags);
  d.contact.pairs[0].friction = 0.0;
  EXPECT_FALSE(test::build(d).contact_laws.drags);
}

TEST(contact_pairs, give_the_same_bits_as_the_same_settings_for_all) {
  auto all = thrown();
  all.contact.friction = 0.4;
  all.contact.damping = 0.2;
  all.contact.penalty_scale = 2.0;
  auto one = thrown();
  one.contact.pairs = {pair("plate", "ball")};
  one.contact.pairs[0].friction = 0.4;
  one.contact.pairs[0].damping = 0.2;
  one.contact.pairs[0].penalty_scale = 2.0;
  const PairOutcome expected = run(all);
  EXPECT_GT(expected.friction, 0.0);
  EXPECT_EQ(run(one).hash, expected.hash);
  one.contact.edges = all.contact.edges = false;
  EXPECT_EQ(run(one).hash, run(all).hash);
}

TEST(contact_pairs, leave_those_alone_that_they_do_not_name) {
  auto d = thrown();
  const PairOutcome plain = run(d);
  EXPECT_EQ(plain.friction, 0.0);
  d.contact.pairs = {pair("plate", "other"), pair("ball", "ball")};
  for (model::ContactPair& p : d.contact.pairs) {
    p.friction = 0.4;
    p.stiffness = 1.0e9;
    p.damping = 0.3;
  }
  EXPECT_EQ(run(d).hash, plain.hash);
  d.contact.pairs[1].bodies = {"ball", "plate"};
  d.contact.pairs[1].stiffness = 2.0e3;
  EXPECT_NE(run(d).hash, plain.hash);
}

TEST(contact_pairs, that_are_stiffer_let_less_in) {
  auto d = thrown();
  const double plain = run(d).deepest;
  d.contact.pairs = {pair("plate", "ball")};
  d.contact.pairs[0].penalty_scale = 4.0;
  EXPECT_LT(run(d).deepest, 0.7 * plain);
}

TEST(contact_pairs, harden_unless_they_or_all_have_a_given_stiffness_or_the_deck_says_how_much) {
  auto d = thrown();
  d.contact.pairs = {pair("plate", "ball"), pair("ball", "ball")};
  d.contact.pairs[0].stiffness = 1.0e4;
  d.contact.pairs[1].penalty_scale = 2.0;
  const auto hardenings = [&] {
    std::vector<double> all;
    for (const model::ContactLaw& law : test::build(d).contact_laws.laws) {
      all.push_back(law.hardening);
    }
    return all;
  };
  constexpr double usual = model::ContactSettings::usual_hardening;
  EXPECT_EQ(hardenings(), (std::vector{usual, 0.0, usual}));
  d.contact.hardening = 3.5;
  EXPECT_EQ(hardenings(), (std::vector{3.5, 3.5, 3.5}));
  d.contact.hardening.reset();
  d.contact.stiffness = 1.0e5;
  d.contact.pairs = {};
  EXPECT_EQ(hardenings(), (std::vector{0.0}));
}

TEST(penalty, by_element_is_half_of_modulus_times_thickness_of_the_softest_shell) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.02);
  d.materials.push_back({"hard", physics::LinearElastic{1000.0, 4.0e6, 0.2}, {}});
  d.sections.push_back({"hard", "hard", 0.01, {}});
  test::add_body(d, "soft", test::plate(1.0, 1.0, 2, 2));
  test::add_body(d, "hard", test::plate(1.0, 1.0, 2, 2)).translate.z = 1.0;
  d.bodies.back().section = "hard";
  d.contact.penalty = "element";
  d.contact.penalty_scale = 3.0;
  const model::Model model = test::build(d);
  for (Index n = 0; n < model.node_count(); ++n) {
    const double expected = 3.0 * 0.5 * (model.node_body[at(n)] == 0 ? 1.0e6 * 0.02 : 4.0e6 * 0.01);
    EXPECT_NEAR(model.contact_stiffness[at(n)], expected, 1e-12 * expected);
  }
  d.contact.penalty = "step";
  auto left_out = d;
  left_out.contact.penalty.clear();
  EXPECT_EQ(test::build(d).contact_stiffness, test::build(left_out).contact_stiffness);
  EXPECT_NE(test::build(d).contact_stiffness, model.contact_stiffness);
}

TEST(penalty, at_a_node_of_two_sections_is_that_of_the_softer_one) {
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.02);
  d.sections.push_back({"thin", "m", 0.005, {}});
  model::Mesh mesh = test::mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  mesh.part_names = {"thick", "thin"};
  mesh.part = {0, 1};
  test::add_body(d, "two", model::CubedSphere{}).parts = {{"thin", "thin", {}}};
  d.contact.penalty = "element";
  const model::Model model = test::build(d, {mesh});
  EXPECT_NEAR(model.contact_stiffness[0], 0.5 * 1.0e6 * 0.005, 1e-8);
  EXPECT_NEAR(model.contact_stiffness[1], 0.5 * 1.0e6 * 0.02, 1e-8);
  EXPECT_NEAR(model.contact_stiffness[2], 0.5 * 1.0e6 * 0.005, 1e-8);
  EXPECT_NEAR(model.contact_stiffness[3], 0.5 * 1.0e6 * 0.005, 1e-8);
}

}  // namespace
}  // namespace fexp
