// SPDX-License-Identifier: Apache-2.0
#include "model/node_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

using test::add_body;
using test::build;

using test::steel;

/// Three copies "p[i,0,0]" of a plate of 3 x 3 nodes, side by side, and a sphere "s".
Description plates_and_sphere() {
  Description d = test::description(steel, 0.01);
  add_body(d, "p", Plate{2.0, 2.0, 2, 2, "one"}).array = Array{{3, 1, 1}, {10.0, 0.0, 0.0}};
  add_body(d, "s", CubedSphere{1.0, 2}).translate = {0.0, 50.0, 0.0};
  return d;
}

NodeSet& add_set(Description& d, const std::string& name) {
  d.node_sets.emplace_back().name = name;
  return d.node_sets.back();
}

const std::vector<Index>& nodes_of(const Model& model, const std::string& name) {
  return std::find_if(model.node_sets.begin(), model.node_sets.end(),
                      [&](const NamedNodes& s) { return s.name == name; })
      ->nodes;
}

std::vector<Index> range(Index begin, Index end) {
  std::vector<Index> all;
  for (Index i = begin; i < end; ++i) {
    all.push_back(i);
  }
  return all;
}

TEST(node_sets, all_is_always_there_and_holds_every_node) {
  const Model m = build(plates_and_sphere());
  EXPECT_EQ(nodes_of(m, "all"), range(0, m.node_count()));
}

TEST(node_sets, a_described_body_means_all_copies_and_a_copy_only_itself) {
  Description d = plates_and_sphere();
  add_set(d, "plates").bodies = {"p"};
  add_set(d, "middle").bodies = {"p[1,0,0]"};
  add_set(d, "both").bodies = {"p[2,0,0]", "p"};
  const Model m = build(d);
  EXPECT_EQ(nodes_of(m, "plates"), range(0, 27));
  EXPECT_EQ(nodes_of(m, "middle"), range(9, 18));
  EXPECT_EQ(nodes_of(m, "both"), range(0, 27));
}

TEST(node_sets, selections_are_taken_together) {
  Description d = plates_and_sphere();
  NodeSet& set = add_set(d, "rim");
  set.bodies = {"p[1,0,0]"};
  set.boundary = true;
  set.box = BoxSelection{{10.0, 1.0, 0.0}, {11.0, 2.0, 0.0}};
  const Model m = build(d);
  // Of the four nodes in the box, bounds included, (11, 1) is the plate's middle.
  std::set<std::pair<double, double>> found;
  for (const Index n : nodes_of(m, "rim")) {
    found.emplace(m.reference_position[at(n)].x, m.reference_position[at(n)].y);
  }
  EXPECT_EQ(found, (std::set<std::pair<double, double>>{{10.0, 1.0}, {10.0, 2.0}, {11.0, 2.0}}));
  EXPECT_TRUE(std::is_sorted(nodes_of(m, "rim").begin(), nodes_of(m, "rim").end()));
}

TEST(node_sets, a_closed_surface_has_no_boundary) {
  Description d = plates_and_sphere();
  add_set(d, "rims").boundary = true;
  const Model m = build(d);
  EXPECT_EQ(nodes_of(m, "rims").size(), 3U * 8U);
}

TEST(node_sets, a_group_is_found_in_every_copy_and_cut_by_the_other_selections) {
  Description d = plates_and_sphere();
  d.bodies.pop_back();
  Mesh mesh = generate_mesh(std::get<MeshGenerator>(d.bodies[0].mesh));
  mesh.node_groups = {{"corner", {0}}, {"row", {}}};
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    if (mesh.position[n].y == 1.0) {
      mesh.node_groups[1].nodes.push_back(static_cast<Index>(n));
    }
  }
  add_set(d, "corners").group = "corner";
  NodeSet& cut = add_set(d, "cut");
  cut.group = "row";
  cut.boundary = true;
  cut.box = BoxSelection{{5.0, -1.0, -1.0}, {15.0, 9.0, 9.0}};
  ErrorList errors;
  const Model m = build_model(d, std::span(&mesh, 1), errors);
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(nodes_of(m, "corners"), (std::vector<Index>{0, 9, 18}));
  // Of the middle row of the middle plate, the node in the middle is on no free edge.
  ASSERT_EQ(nodes_of(m, "cut").size(), 2U);
  for (const Index n : nodes_of(m, "cut")) {
    EXPECT_EQ(m.node_body[at(n)], 1);
    EXPECT_EQ(m.reference_position[at(n)].y, 1.0);
    EXPECT_NE(m.reference_position[at(n)].x, 11.0);
  }
}

TEST(node_sets, fixed_conditions_merge_and_lie_in_the_ranges_of_their_bodies) {
  Description d = plates_and_sphere();
  add_set(d, "middle").bodies = {"p[1,0,0]"};
  test::add_box_set(d, "edge", {10.0, 0.0, 0.0}, {10.0, 9.0, 0.0});
  test::fix(d, "edge", {"rx", "x"});
  test::fix(d, "middle", {"z"});
  const Model m = build(d);
  EXPECT_EQ(m.bodies[0].fixed.size(), 0);
  EXPECT_EQ(m.bodies[1].fixed, (IndexRange{0, 9}));
  EXPECT_EQ(m.bodies[3].fixed.size(), 0);
  for (const FixedNode& f : m.fixed) {
    EXPECT_EQ(f.mask, m.reference_position[at(f.node)].x == 10.0 ? 0b001101 : 0b000100);
  }
}

TEST(node_sets, only_a_body_held_in_all_degrees_of_freedom_is_a_barrier) {
  Description d = plates_and_sphere();
  add_set(d, "first").bodies = {"p[0,0,0]"};
  add_set(d, "second").bodies = {"p[1,0,0]"};
  test::add_box_set(d, "most", {20.0, 0.0, 0.0}, {22.0, 1.0, 0.0});
  test::fix(d, "first", {"x", "y", "z", "rx", "ry", "rz"});
  test::fix(d, "second", {"x", "y", "z", "rx", "ry"});
  test::fix(d, "most", {"x", "y", "z", "rx", "ry", "rz"});
  const Model m = build(d);
  EXPECT_TRUE(m.bodies[0].barrier);
  EXPECT_FALSE(m.bodies[1].barrier);
  EXPECT_FALSE(m.bodies[2].barrier);
  EXPECT_FALSE(m.bodies[3].barrier);
}

TEST(node_sets, prescribed_motion_is_sorted_and_finds_its_curve) {
  Description d = plates_and_sphere();
  add_set(d, "middle").bodies = {"p[1,0,0]"};
  add_set(d, "first").bodies = {"p[0,0,0]"};
  d.curves = {{"other", {{0.0, 1.0}}, {}}, {"ramp", {{0.0, 0.0}, {1.0, 1.0}}, {}}};
  d.prescribed = {{"middle", "ry", 2.0, "ramp", {}}, {"middle", "x", 3.0, "", {}}, {"first", "z", 4.0, "", {}}};
  const Model m = build(d);
  ASSERT_EQ(m.prescribed.size(), 27U);
  EXPECT_EQ(m.bodies[0].prescribed, (IndexRange{0, 9}));
  EXPECT_EQ(m.bodies[1].prescribed, (IndexRange{9, 27}));
  EXPECT_EQ(m.prescribed[9].dof, 0);
  EXPECT_EQ(m.prescribed[9].curve, no_index);
  EXPECT_EQ(m.prescribed[10].node, 9);
  EXPECT_EQ(m.prescribed[10].dof, 4);
  EXPECT_EQ(m.prescribed[10].curve, 1);
}

TEST(node_sets, a_total_force_is_shared_equally_and_a_single_one_is_not) {
  Description d = plates_and_sphere();
  add_set(d, "middle").bodies = {"p[1,0,0]"};
  NodalForce total;
  total.set = "middle";
  total.force = {18.0, 0.0, 0.0};
  total.moment = {0.0, 9.0, 0.0};
  total.total = true;
  NodalForce each = total;
  each.total = false;
  each.moment = {};
  d.forces = {total, each};
  const Model m = build(d);
  EXPECT_EQ(m.bodies[1].forces, (IndexRange{0, 18}));
  Vec3d force, moment;
  for (const NodeLoad& load : m.forces) {
    force += load.force;
    moment += load.moment;
  }
  EXPECT_NEAR(force.x, 18.0 + 9.0 * 18.0, 1e-12);
  EXPECT_NEAR(moment.y, 9.0, 1e-12);
}

TEST(node_sets, pressure_loads_the_elements_of_its_bodies_and_part) {
  Description d = plates_and_sphere();
  d.pressure = {{{"p[2,0,0]", "s"}, "", 5.0, "", {}}};
  Model m = build(d);
  EXPECT_EQ(m.bodies[0].pressure.size(), 0);
  EXPECT_EQ(m.bodies[2].pressure.size(), m.bodies[2].elements.size());
  EXPECT_EQ(m.bodies[3].pressure.size(), m.bodies[3].elements.size());
  EXPECT_EQ(m.pressure.front().element, m.bodies[2].elements.begin);
  d.bodies.pop_back();
  d.pressure = {{{"p"}, "half", 5.0, "", {}}};
  Mesh mesh = generate_mesh(std::get<MeshGenerator>(d.bodies[0].mesh));
  mesh.part_names.emplace_back("half");
  mesh.part[1] = mesh.part[6] = 1;
  ErrorList errors;
  m = build_model(d, std::span(&mesh, 1), errors);
  ASSERT_TRUE(errors.empty());
  EXPECT_EQ(m.pressure.size(), 6U);
  for (const Body& body : m.bodies) {
    EXPECT_EQ(body.pressure.size(), 2);
  }
}

TEST(node_sets, planes_of_symmetry_that_meet_are_made_orthogonal_and_repeats_left_out) {
  Description d = plates_and_sphere();
  test::add_box_set(d, "corner", {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  d.symmetry = {{"corner", {2.0, 0.0, 0.0}, {}}, {"corner", {-3.0, 0.0, 0.0}, {}}, {"corner", {1.0, 1.0, 0.0}, {}}};
  const Model m = build(d);
  ASSERT_EQ(m.symmetry.size(), 2U);
  EXPECT_EQ(m.symmetry[0].normal, (Vec3d{1.0, 0.0, 0.0}));
  EXPECT_NEAR(norm(m.symmetry[1].normal - Vec3d{0.0, 1.0, 0.0}), 0.0, 1e-15);
  EXPECT_EQ(m.bodies[0].symmetry, (IndexRange{0, 2}));
}

}  // namespace
}  // namespace fexp::model
