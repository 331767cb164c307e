// SPDX-License-Identifier: Apache-2.0
#include "contact/initial_penetrations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "app/load.hpp"
#include "app/penetrations.hpp"
#include "contact/separation.hpp"
#include "support/contact.hpp"
#include "support/temporary_directory.hpp"

/// Shells that are nearer before the start than their thicknesses allow.
namespace fexp {
namespace {

constexpr double thickness = 0.1;

model::Description shells(double t = thickness) {
  auto d = test::description(test::rubber, t);
  d.contact.enabled = true;
  return d;
}

/// Two plates one above the other at a distance; the upper one is shifted and has other elements.
model::Description two_plates(double distance, double t = thickness) {
  auto d = shells(t);
  test::add_body(d, "lower", test::plate(2.0, 2.0, 6, 6));
  test::add_body(d, "upper", test::plate(2.0, 2.0, 5, 5)).translate = {0.13, 0.07, distance};
  return d;
}

contact::InitialPenetrations found_in(const model::Model& model) {
  return contact::find_initial_penetrations(model, model.reference_position);
}

std::vector<contact::PenetratingBodies> bodies_in(const model::Model& model) {
  return contact::by_bodies(model, found_in(model));
}

TEST(initial_penetrations, are_told_by_pairs_of_bodies_with_the_deepest) {
  auto d = two_plates(0.06);
  test::add_body(d, "far", test::plate(1.0, 1.0, 2, 2)).translate = {0.0, 0.0, 1.0};
  const model::Model model = test::build(d);
  const auto groups = bodies_in(model);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(std::min(groups[0].body, groups[0].other), 0);
  EXPECT_EQ(std::max(groups[0].body, groups[0].other), 1);
  EXPECT_FALSE(groups[0].same_body);
  EXPECT_GT(groups[0].count, 40);
  EXPECT_NEAR(groups[0].deepest.depth(), 0.04, 1e-12);
  EXPECT_NEAR(groups[0].deepest.contact_distance, 0.1, 1e-15);
  EXPECT_EQ(groups[0].crossings, 0);
}

TEST(initial_penetrations, are_none_where_shells_just_touch_or_may_not_touch) {
  EXPECT_TRUE(bodies_in(test::build(two_plates(0.1))).empty());
  EXPECT_FALSE(bodies_in(test::build(two_plates(0.0998))).empty());
  auto d = two_plates(0.06);
  d.contact.exclude = {{"lower", "upper"}};
  EXPECT_TRUE(bodies_in(test::build(d)).empty());
  d = two_plates(0.06);
  d.contact.enabled = false;
  EXPECT_TRUE(bodies_in(test::build(d)).empty());
  d = two_plates(0.06);
  d.node_sets.emplace_back().name = "both";
  test::fix(d, "both", {"x", "y", "z", "rx", "ry", "rz"});
  EXPECT_TRUE(bodies_in(test::build(d)).empty());
}

TEST(initial_penetrations, within_a_body_are_none_of_neighbours_in_a_thick_shell) {
  for (const double t : {0.01, 0.3, 0.6}) {
    auto d = shells(t);
    test::add_body(d, "plate", test::plate(2.0, 2.0, 12, 12));
    test::add_body(d, "box", model::OpenBox{3.0, 3.0, 2.0, 10, 10, 8}).translate = {10.0, 0.0, 0.0};
    EXPECT_TRUE(bodies_in(test::build(d)).empty()) << t;
  }
}

TEST(initial_penetrations, within_a_body_are_those_of_walls_that_are_far_apart_along_the_mesh) {
  auto d = shells(0.06);
  test::add_body(d, "box", model::OpenBox{1.0, 0.05, 1.0, 10, 1, 10});
  const model::Model model = test::build(d);
  const auto groups = bodies_in(model);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_TRUE(groups[0].same_body);
  EXPECT_NEAR(groups[0].deepest.depth(), 0.01, 1e-12);
  d.contact.self = false;
  EXPECT_TRUE(bodies_in(test::build(d)).empty());
}

/// Two roofs whose ridges cross.
model::Model roofs(double gap, bool edges) {
  auto d = shells();
  d.contact.edges = edges;
  test::add_body(d, "lower", model::CubedSphere{});
  test::add_body(d, "upper", model::CubedSphere{});
  return test::build(
      d, {test::mesh({{-1, 0, 0}, {1, 0, 0}, {0, 1, -0.5}, {0, -1, -0.5}}, {{0, 1, 2}, {1, 0, 3}}),
          test::mesh({{0.1, -1, gap}, {0.2, 1, gap}, {1, 0, gap + 0.5}, {-1, 0, gap + 0.5}}, {{0, 2, 1}, {1, 3, 0}})});
}

TEST(initial_penetrations, are_those_of_crossing_edges_too) {
  const auto found = found_in(roofs(0.07, true));
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_TRUE(found.pairs[0].of_edges);
  EXPECT_NEAR(found.pairs[0].depth(), 0.03, 1e-12);
  EXPECT_TRUE(found_in(roofs(0.07, false)).pairs.empty());
  EXPECT_TRUE(found_in(roofs(0.11, true)).pairs.empty());
  EXPECT_TRUE(found.crossings.empty());
}

/// A plate that stands on another one or passes through it.
model::Description standing(double low) {
  auto d = shells(0.02);
  test::add_body(d, "floor", test::plate(2.0, 2.0, 5, 5)).translate = {-1.0, -1.0, 0.0};
  model::BodyDescription& wall = test::add_body(d, "wall", test::plate(1.0, 1.0, 3, 3));
  wall.rotate.push_back({{1.0, 0.0, 0.0}, 90.0, {}});
  wall.translate = {-0.47, 0.03, low};
  return d;
}

TEST(initial_penetrations, surfaces_cross_where_edges_pass_through_elements) {
  for (const auto& [low, crosses] : {std::pair{-0.1, true}, {0.0, false}, {0.01, false}, {0.3, false}}) {
    const auto found = found_in(test::build(standing(low)));
    EXPECT_EQ(!found.crossings.empty(), crosses) << low;
    EXPECT_EQ(found.pairs.empty(), low > 0.02) << low;
  }
  const auto groups = bodies_in(test::build(standing(-0.1)));
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_GE(groups[0].crossings, 4);
}

/// Builds the model anew with its nodes apart.
model::Model apart(const model::Description& d, contact::Separation& separation) {
  const model::Model before = test::build(d);
  separation = contact::separate(before, found_in(before));
  std::vector<model::Mesh> meshes;
  for (const model::BodyDescription& body : d.bodies) {
    meshes.push_back(model::generate_mesh(std::get<model::MeshGenerator>(body.mesh)));
  }
  ErrorList errors;
  model::Model model = model::build_model(d, meshes, errors, separation.position);
  EXPECT_TRUE(errors.empty());
  return model;
}

double height(const model::Model& model, Index body, double (*most)(double, double)) {
  double z = model.reference_position[at(model.bodies[at(body)].nodes.begin)].z;
  for (Index n = model.bodies[at(body)].nodes.begin; n < model.bodies[at(body)].nodes.end; ++n) {
    z = most(z, model.reference_position[at(n)].z);
  }
  return z;
}

double larger(double a, double b) { return std::max(a, b); }
double smaller(double a, double b) { return std::min(a, b); }

TEST(separation, moves_both_sides_until_nothing_penetrates_and_leaves_no_stress_or_energy) {
  auto d = two_plates(0.06);
  contact::Separation separation;
  const model::Model model = apart(d, separation);
  EXPECT_TRUE(separation.left.pairs.empty());
  EXPECT_GT(separation.moved, 40);
  EXPECT_GT(separation.largest_move, 0.015);
  EXPECT_LT(separation.largest_move, 0.045);
  EXPECT_TRUE(bodies_in(model).empty());
  EXPECT_LT(height(model, 0, smaller), -0.01);
  EXPECT_GT(height(model, 1, larger), 0.07);
  const model::State state = model::initial_state(model);
  test::Contact contact(model, state);
  EXPECT_EQ(contact.evaluate(model, state, 0.0).active_pairs, 0);
  EXPECT_EQ(contact.energy(), 0.0);
}

TEST(separation, is_the_same_whenever_it_is_done_and_nothing_where_nothing_penetrates) {
  const model::Model model = test::build(two_plates(0.06));
  EXPECT_EQ(contact::separate(model, found_in(model)).position, contact::separate(model, found_in(model)).position);
  const model::Model fine = test::build(two_plates(0.1));
  const contact::Separation none = contact::separate(fine, found_in(fine));
  EXPECT_EQ(none.moved, 0);
  EXPECT_EQ(none.position, fine.reference_position);
}

TEST(separation, leaves_barriers_rigid_bodies_and_nodes_with_conditions_where_they_are) {
  for (const int which : {0, 1, 2}) {
    auto d = two_plates(0.06);
    if (which == 1) {
      d.bodies[0].rigid = true;
    } else {
      d.node_sets.emplace_back().name = "held";
      d.node_sets.back().bodies = {"lower"};
      test::fix(d, "held",
                which == 0 ? std::vector<std::string>{"x", "y", "z", "rx", "ry", "rz"} : std::vector<std::string>{"x"});
    }
    contact::Separation separation;
    const model::Model model = apart(d, separation);
    EXPECT_EQ(height(model, 0, smaller), 0.0);
    EXPECT_EQ(height(model, 0, larger), 0.0);
    EXPECT_GE(height(model, 1, larger), 0.1);
    EXPECT_TRUE(bodies_in(model).empty()) << which;
  }
}

TEST(separation, tells_what_neither_side_gives_way_to) {
  auto d = two_plates(0.06);
  d.bodies[0].rigid = d.bodies[1].rigid = true;
  contact::Separation separation;
  const model::Model model = apart(d, separation);
  EXPECT_EQ(separation.moved, 0);
  EXPECT_EQ(separation.left.pairs.size(), found_in(model).pairs.size());
  EXPECT_FALSE(separation.left.pairs.empty());
}

TEST(separation, spoils_no_element) {
  // Elements are far smaller than what the shells would have to move by.
  auto d = shells(0.3);
  test::add_body(d, "lower", test::plate(2.0, 2.0, 40, 40));
  test::add_body(d, "upper", test::plate(1.0, 1.0, 20, 20)).translate = {0.51, 0.52, 0.02};
  const model::Model before = test::build(d);
  const contact::Separation separation = contact::separate(before, found_in(before));
  EXPECT_FALSE(separation.left.pairs.empty());
  EXPECT_TRUE(separation.left.crossings.empty());
  for (const auto& t : before.triangle) {
    const auto area = [&](const std::vector<Vec3d>& x) {
      return cross(x[at(t[1])] - x[at(t[0])], x[at(t[2])] - x[at(t[0])]);
    };
    const Vec3d was = area(before.reference_position), is = area(separation.position);
    EXPECT_GT(norm(is), 0.5 * norm(was));
    EXPECT_GT(dot(was, is), 0.5 * norm(was) * norm(is));
  }
}

TEST(separation, parts_crossing_edges) {
  const model::Model before = roofs(0.07, true);
  const contact::Separation separation = contact::separate(before, found_in(before));
  EXPECT_EQ(separation.moved, 4);
  EXPECT_TRUE(separation.left.pairs.empty());
}

TEST(separation, leaves_the_node_sets_as_they_were) {
  auto d = two_plates(0.06);
  test::add_box_set(d, "upper", {-1.0, -1.0, 0.05}, {3.0, 3.0, 0.0601});
  contact::Separation separation;
  const model::Model model = apart(d, separation);
  ASSERT_EQ(model.node_sets.back().name, "upper");
  EXPECT_EQ(model.node_sets.back().nodes.size(), 36U);
}

/// A deck of two plates; what it is read to.
app::Case load(const std::string& contact, const char* distance, const char* turn = "") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "deck.toml";
  std::ofstream(path) << R"([run]
duration = 1e-3
[[material]]
name = "m"
density = 1000
young = 1e6
poisson = 0.3
[[section]]
name = "s"
material = "m"
thickness = 0.1
[[body]]
name = "a"
section = "s"
mesh = { kind = "plate", length_x = 2, length_y = 2, cells_x = 4, cells_y = 4 }
[[body]]
name = "b"
section = "s"
mesh = { kind = "plate", length_x = 2, length_y = 2, cells_x = 3, cells_y = 3 }
)"
                      << "translate = [0.1, 0.1, " << distance << "]\n"
                      << turn << "[contact]\n"
                      << contact;
  return app::load_case(path);
}

TEST(load, keeps_or_removes_what_penetrates_and_reports_it) {
  const app::Case kept = load("", "0.06");
  ASSERT_EQ(kept.penetrations.found.size(), 1U);
  EXPECT_FALSE(kept.penetrations.removed);
  EXPECT_NEAR(kept.penetrations.found[0].depth, 0.04, 1e-12);
  EXPECT_EQ(app::penetration_lines(kept.penetrations).size(), 1U);
  ASSERT_EQ(app::penetration_findings(kept.penetrations).size(), 1U);
  EXPECT_EQ(app::penetration_findings(kept.penetrations)[0].kind, "initial_penetration");

  const app::Case removed = load("initial_penetrations = \"remove\"", "0.06");
  EXPECT_TRUE(removed.penetrations.removed);
  EXPECT_TRUE(removed.penetrations.left.empty());
  EXPECT_EQ(removed.penetrations.found.size(), 1U);
  EXPECT_EQ(app::penetration_lines(removed.penetrations).size(), 2U);
  ASSERT_EQ(app::penetration_findings(removed.penetrations).size(), 1U);
  EXPECT_EQ(app::penetration_findings(removed.penetrations)[0].kind, "moved_apart");
  EXPECT_NE(removed.model.reference_position, kept.model.reference_position);
  EXPECT_TRUE(found_in(removed.model).pairs.empty());

  const app::Case fine = load("initial_penetrations = \"remove\"", "0.2");
  EXPECT_FALSE(fine.penetrations.removed);
  EXPECT_TRUE(app::penetration_lines(fine.penetrations).empty());
  EXPECT_TRUE(app::penetration_findings(fine.penetrations).empty());
}

TEST(load, refuses_to_part_surfaces_that_pass_through_each_other) {
  const char* turn = "rotate = [{ axis = [1, 0, 0], angle_degrees = 60, point = [0, 1, 0] }]\n";
  const app::Case kept = load("", "0.06", turn);
  const auto findings = app::penetration_findings(kept.penetrations);
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const quality::Finding& f) {
    return f.kind == "crossing" && f.message.find("passes through body") != std::string::npos;
  }));
  try {
    static_cast<void>(load("initial_penetrations = \"remove\"", "0.06", turn));
    FAIL() << "no error";
  } catch (const InputErrors& errors) {
    ASSERT_EQ(errors.errors().size(), 1U);
    EXPECT_EQ(errors.errors()[0].place.line, 22);
    EXPECT_NE(errors.errors()[0].text().find("contact.initial_penetrations = \"remove\" cannot undo"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace fexp
