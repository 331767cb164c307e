// SPDX-License-Identifier: Apache-2.0
#include "model/build.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "model/topology.hpp"
#include "parallel/parallel.hpp"
#include "physics/critical_step.hpp"
#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

using test::add_body;
using test::build;

using test::steel;
constexpr double thickness = 0.004;

Description one_body(const MeshGenerator& mesh) {
  Description d = test::description(steel, thickness);
  add_body(d, "a", mesh);
  return d;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Two squares of two triangles each, "left" and "right", with the parts taking turns in the file's order.
Mesh two_part_strip() {
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.triangle = {{0, 1, 4}, {1, 2, 5}, {0, 4, 3}, {1, 5, 4}};
  mesh.part = {0, 1, 0, 1};
  mesh.part_names = {"left", "right"};
  mesh.triangle_label = {11, 12, 13, 14};
  mesh.node_label = {101, 102, 103, 104, 105, 106};
  return mesh;
}

Description two_part_description() {
  Description d = test::description(steel, thickness);
  d.sections.push_back({"thick", "m", 3.0 * thickness, {}});
  BodyDescription body;
  body.name = "strip";
  body.section = "s";
  body.parts.push_back({"left", "thick", {}});
  body.mesh = MeshFile{"strip.msh"};
  d.bodies.push_back(body);
  return d;
}

TEST(build_model, plate_weighs_density_times_thickness_times_area) {
  const Model m = build(one_body(Plate{2.0, 3.0, 7, 5, "alternating"}));
  const double mass = steel.density * thickness * 6.0;
  EXPECT_NEAR(sum(m.mass), mass, 1e-12 * mass);
  EXPECT_NEAR(m.bodies[0].mass, mass, 1e-12 * mass);
  EXPECT_NEAR(sum(m.reference_area), 6.0, 1e-12);
}

TEST(build_model, each_interior_node_of_a_regular_plate_carries_one_cell) {
  const Model m = build(one_body(Plate{4.0, 3.0, 4, 3, "one"}));
  for (std::size_t n = 0; n < m.mass.size(); ++n) {
    const Vec3d& x = m.reference_position[n];
    if (x.x > 0.5 && x.x < 3.5 && x.y > 0.5 && x.y < 2.5) {
      const double mass = steel.density * thickness;
      EXPECT_NEAR(m.mass[n], mass, 1e-13 * mass);
      // Every triangle has area 1/2, so every corner has the same inertia over mass.
      EXPECT_NEAR(m.inertia[n], mass * (0.5 / 4.5 + thickness * thickness / 12.0), 1e-13 * mass);
    }
  }
}

TEST(build_model, mass_of_a_sphere_converges_to_the_closed_form_with_the_square_of_the_cell) {
  const double exact = steel.density * thickness * 4.0 * std::numbers::pi * 0.25;
  const double coarse = 1.0 - build(one_body(CubedSphere{0.5, 8})).bodies[0].mass / exact;
  const double fine = 1.0 - build(one_body(CubedSphere{0.5, 16})).bodies[0].mass / exact;
  EXPECT_GT(fine, 0.0);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(build_model, critical_step_is_the_smallest_of_the_elements_and_names_the_first_of_equals) {
  const Model m = build(one_body(Plate{3.0, 1.0, 3, 1, "one"}));
  double smallest = HUGE_VAL;
  for (Index e = 0; e < m.element_count(); ++e) {
    const auto& t = m.triangle[at(e)];
    const auto frame = physics::triangle_frame(m.reference_position[at(t[1])] - m.reference_position[at(t[0])],
                                               m.reference_position[at(t[2])] - m.reference_position[at(t[0])]);
    const double step =
        physics::element_critical_step({thickness, steel.moduli(), m.run.drilling}, steel.density, frame);
    if (step < smallest) {
      smallest = step;
      EXPECT_TRUE(e < m.first_critical_element || step == m.first_critical_step);
    }
  }
  EXPECT_EQ(m.first_critical_step, smallest);
  EXPECT_GT(m.first_critical_step, 0.0);
}

TEST(build_model, penalty_keeps_the_courant_number_of_a_node_at_the_stated_constant) {
  Description d = one_body(CubedSphere{0.5, 4});
  d.contact.penalty_scale = 0.25;
  const Model m = build(d);
  for (std::size_t n = 0; n < m.mass.size(); ++n) {
    // omega dt with the model's step is never above that with the node's own, larger, step.
    const double courant = std::sqrt(m.contact_stiffness[n] / m.mass[n]) * m.first_critical_step;
    EXPECT_LE(courant, penalty_courant * 0.5 * (1.0 + 1e-12));
  }
  const auto& t = m.triangle[at(m.first_critical_element)];
  const double k = m.contact_stiffness[at(t[0])], mass = m.mass[at(t[0])];
  EXPECT_NEAR(std::sqrt(k / mass) * m.first_critical_step, penalty_courant * 0.5, 1e-12);
}

TEST(build_model, parts_get_their_sections_and_no_block_mixes_them) {
  const Mesh mesh = two_part_strip();
  ErrorList errors;
  const Model m = build_model(two_part_description(), std::span(&mesh, 1), errors);
  ASSERT_TRUE(errors.empty());
  ASSERT_EQ(m.block_count(), 2);
  EXPECT_EQ(m.bodies[0].blocks, (IndexRange{0, 2}));
  for (Index e = 0; e < 4; ++e) {
    const bool left = m.element_label[at(e)] == 11 || m.element_label[at(e)] == 13;
    EXPECT_EQ(m.section_of(e).thickness, left ? 3.0 * thickness : thickness);
    EXPECT_EQ(m.element_part[at(e)], left ? 0 : 1);
  }
  // Within a section the order of the file stays.
  EXPECT_EQ(m.element_label, (std::vector<std::int64_t>{12, 14, 11, 13}));
  EXPECT_EQ(m.node_label, mesh.node_label);
  // Nodes on the seam take the thicker side.
  EXPECT_EQ(m.half_thickness[1], 1.5 * thickness);
  EXPECT_EQ(m.half_thickness[2], 0.5 * thickness);
}

TEST(build_model, neighbours_and_corners_agree_with_the_reordered_triangles) {
  const Mesh mesh = two_part_strip();
  Description d = two_part_description();
  d.bodies[0].array = Array{{2, 1, 1}, {5.0, 0.0, 0.0}};
  ErrorList errors;
  const Model m = build_model(d, std::span(&mesh, 1), errors);
  ASSERT_TRUE(errors.empty());
  int shared = 0;
  for (Index e = 0; e < m.element_count(); ++e) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Index other = m.neighbour[at(e)][a];
      if (other == no_index) {
        continue;
      }
      ++shared;
      const Index n1 = m.triangle[at(e)][a], n2 = m.triangle[at(e)][(a + 1) % 3];
      const auto& t = m.triangle[at(other)];
      EXPECT_NE(std::find(t.begin(), t.end(), n1), t.end());
      EXPECT_NE(std::find(t.begin(), t.end(), n2), t.end());
    }
  }
  EXPECT_EQ(shared, 2 * 2 * 3);
  for (Index n = 0; n < m.node_count(); ++n) {
    for (Index c = m.corner_start[at(n)]; c < m.corner_start[at(n) + 1]; ++c) {
      const Index corner = m.corner[at(c)];
      EXPECT_EQ(m.triangle[at(corner / 3)][at(corner % 3)], n);
    }
  }
}

TEST(build_model, copies_of_an_array_are_shifted_named_and_otherwise_alike) {
  Description d = one_body(Plate{1.0, 1.0, 3, 3, "one"});
  d.bodies[0].array = Array{{2, 1, 3}, {1.5, 7.0, 0.5}};
  const Model m = build(d);
  ASSERT_EQ(m.body_count(), 6);
  EXPECT_EQ(m.bodies[0].name, "a[0,0,0]");
  EXPECT_EQ(m.bodies[3].name, "a[1,0,1]");
  EXPECT_EQ(m.bodies[3].family, "a");
  Index next_node = 0, next_element = 0, next_block = 0;
  for (Index b = 0; b < 6; ++b) {
    const Body& body = m.bodies[at(b)];
    EXPECT_EQ(body.nodes, (IndexRange{next_node, next_node + 16}));
    EXPECT_EQ(body.elements, (IndexRange{next_element, next_element + 18}));
    EXPECT_EQ(body.blocks, (IndexRange{next_block, next_block + 3}));
    next_node = body.nodes.end;
    next_element = body.elements.end;
    next_block = body.blocks.end;
    EXPECT_NEAR(body.mass, m.bodies[0].mass, 1e-12 * body.mass);
    for (Index n = 0; n < 16; ++n) {
      const Vec3d shift = m.reference_position[at(body.nodes.begin + n)] - m.reference_position[at(n)];
      EXPECT_NEAR(shift.x, 1.5 * (b % 2), 1e-14);
      const Index layer = b / 2;
      EXPECT_NEAR(shift.z, 0.5 * layer, 1e-14);
      EXPECT_EQ(shift.y, 0.0);
      EXPECT_EQ(m.node_body[at(body.nodes.begin + n)], b);
      EXPECT_EQ(m.node_label[at(body.nodes.begin + n)], n);
    }
    for (Index e = body.blocks.begin; e < body.blocks.end; ++e) {
      EXPECT_EQ(m.blocks[at(e)].body, b);
    }
  }
  EXPECT_EQ(m.blocks[2].count, 2);
}

/// The triangle (0,0,0), (1,0,0), (0,1,0), placed as `place` says.
std::vector<Vec3d> placed_triangle(const std::function<void(BodyDescription&)>& place) {
  Description d = test::description(steel, thickness);
  BodyDescription body;
  body.name = "t";
  body.section = "s";
  place(body);
  d.bodies.push_back(body);
  Mesh mesh;
  mesh.position = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  mesh.triangle = {{0, 1, 2}};
  mesh.part = {0};
  ErrorList errors;
  const Model m = build_model(d, std::span(&mesh, 1), errors);
  EXPECT_TRUE(errors.empty());
  return m.reference_position;
}

TEST(build_model, placement_scales_then_rotates_in_order_then_shifts) {
  const std::vector<Vec3d> x = placed_triangle([](BodyDescription& body) {
    body.scale = 2.0;
    body.rotate = {{{0.0, 0.0, 3.0}, 90.0, {2.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}, -90.0, {}}};
    body.translate = {0.0, 0.0, 10.0};
  });
  // (2,0,0) is the fixed point of the first rotation and lies on the axis of the second.
  EXPECT_EQ(x[1], (Vec3d{2.0, 0.0, 10.0}));
  // (0,2,0) is (-2,2,0) from the point, turned (-2,-2,0), which is (0,-2,0), turned (0,0,2).
  EXPECT_EQ(x[2], (Vec3d{0.0, 0.0, 12.0}));
}

TEST(build_model, quarter_turns_are_exact_and_other_angles_follow_rodrigues) {
  for (const double angle : {90.0, -90.0, 180.0, 270.0, 360.0, 450.0, -720.0}) {
    const std::vector<Vec3d> x = placed_triangle([&](BodyDescription& body) {
      body.rotate = {{{1.0, 0.0, 0.0}, angle, {}}};
    });
    EXPECT_EQ(x[1], (Vec3d{1.0, 0.0, 0.0}));
    EXPECT_EQ(x[2].x, 0.0);
    EXPECT_TRUE(x[2].y == 0.0 || std::abs(x[2].y) == 1.0) << angle;
    EXPECT_NEAR(x[2].y, std::cos(angle * std::numbers::pi / 180.0), 1e-14);
    EXPECT_NEAR(x[2].z, std::sin(angle * std::numbers::pi / 180.0), 1e-14);
  }
  const std::vector<Vec3d> x = placed_triangle([](BodyDescription& body) {
    body.rotate = {{{1.0, 1.0, 1.0}, 120.0, {}}};
  });
  EXPECT_NEAR(norm(x[1] - Vec3d{0.0, 1.0, 0.0}), 0.0, 1e-15);
}

TEST(build_model, flipping_turns_every_normal_and_nothing_else) {
  const Model plain = build(one_body(CubedSphere{1.0, 3}));
  Description d = one_body(CubedSphere{1.0, 3});
  d.bodies[0].flip_normals = true;
  const Model flipped = build(d);
  for (Index e = 0; e < plain.element_count(); ++e) {
    const auto normal = [&](const Model& m) {
      const auto& t = m.triangle[at(e)];
      return cross(m.reference_position[at(t[1])] - m.reference_position[at(t[0])],
                   m.reference_position[at(t[2])] - m.reference_position[at(t[0])]);
    };
    EXPECT_LT(dot(normal(plain), normal(flipped)), 0.0);
    EXPECT_EQ(plain.reference_area[at(e)] > 0.0, flipped.reference_area[at(e)] > 0.0);
  }
  EXPECT_EQ(flipped.neighbour, edge_neighbours(flipped.triangle));
}

TEST(build_model, spin_about_the_centre_of_mass_adds_no_momentum) {
  Description d = one_body(Plate{1.0, 2.0, 4, 5, "crossed"});
  d.bodies[0].translate = {10.0, -3.0, 2.0};
  d.bodies[0].velocity = {1.0, 2.0, 3.0};
  d.bodies[0].angular_velocity = {5.0, -7.0, 11.0};
  d.bodies[0].array = Array{{1, 2, 1}, {0.0, 9.0, 0.0}};
  const Model m = build(d);
  for (const Body& body : m.bodies) {
    Vec3d momentum;
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      momentum += m.mass[at(n)] * m.initial_velocity[at(n)];
      EXPECT_EQ(m.initial_rotation_rate[at(n)], d.bodies[0].angular_velocity);
    }
    EXPECT_NEAR(norm((1.0 / body.mass) * momentum - d.bodies[0].velocity), 0.0, 1e-12);
    const Vec3d relative = m.reference_position[at(body.nodes.begin + 1)] - m.reference_position[at(body.nodes.begin)];
    const Vec3d rate = m.initial_velocity[at(body.nodes.begin + 1)] - m.initial_velocity[at(body.nodes.begin)];
    EXPECT_NEAR(norm(rate - cross(d.bodies[0].angular_velocity, relative)), 0.0, 1e-12);
  }
}

TEST(build_model, velocities_of_sets_are_added_to_those_of_bodies_and_of_each_other) {
  auto d = test::description({1.0, 1.0, 0.0}, 0.1);
  test::add_body(d, "plate", Plate{2.0, 2.0, 2, 2, "one"}).velocity = {1.0, 0.0, 0.0};
  test::add_box_set(d, "edge", {2.0, 0.0, 0.0}, {2.0, 2.0, 0.0});
  test::add_box_set(d, "corner", {2.0, 2.0, 0.0}, {2.0, 2.0, 0.0});
  InitialVelocity edge;
  edge.set = "edge";
  edge.velocity = {0.0, 0.0, 3.0};
  InitialVelocity corner;
  corner.set = "corner";
  corner.radial = -5.0;
  corner.axis = {0.0, 0.0, 2.0};
  corner.point = {-1.0, -2.0, 7.0};
  d.initial_velocities = {edge, corner};
  const Model m = test::build(d);
  for (Index n = 0; n < m.node_count(); ++n) {
    const Vec3d& x = m.reference_position[at(n)];
    Vec3d expected{1.0, 0.0, x.x == 2.0 ? 3.0 : 0.0};
    if (x.x == 2.0 && x.y == 2.0) {  // Beside the axis by (3, 4)
      expected += Vec3d{-3.0, -4.0, 0.0};
    }
    EXPECT_NEAR(norm(m.initial_velocity[at(n)] - expected), 0.0, 1e-15);
  }
}

TEST(build_model, is_the_same_for_any_number_of_threads) {
  Description d = one_body(Plate{3.0, 2.0, 200, 150, "alternating"});
  d.bodies[0].rotate = {{{1.0, 2.0, 3.0}, 25.0, {}}};
  d.bodies[0].angular_velocity = {1.0, 2.0, 3.0};
  Model one, two;
  parallel::with_threads(1, [&] { one = build(d); });
  parallel::with_threads(2, [&] { two = build(d); });
  EXPECT_EQ(one.reference_position, two.reference_position);
  EXPECT_EQ(one.triangle, two.triangle);
  EXPECT_EQ(one.neighbour, two.neighbour);
  EXPECT_EQ(one.neighbour, edge_neighbours(one.triangle));
  EXPECT_EQ(one.corner, two.corner);
  EXPECT_EQ(one.mass, two.mass);
  EXPECT_EQ(one.inertia, two.inertia);
  EXPECT_EQ(one.contact_stiffness, two.contact_stiffness);
  EXPECT_EQ(one.initial_velocity, two.initial_velocity);
  EXPECT_EQ(one.first_critical_element, two.first_critical_element);
}

TEST(build_model, planes_get_unit_normals) {
  Description d = one_body(CubedSphere{1.0, 2});
  d.planes.push_back({{"floor"}, {}, {0.0, 0.0, 4.0}});
  EXPECT_EQ(build(d).walls[0].direction, (Vec3d{0.0, 0.0, 1.0}));
}

TEST(build_model, excluded_pairs_are_expanded_over_copies_sorted_and_unique) {
  Description d = one_body(CubedSphere{1.0, 2});
  d.contact.enabled = true;
  d.bodies[0].array = Array{{2, 1, 1}, {3.0, 0.0, 0.0}};
  add_body(d, "b", CubedSphere{1.0, 2}).translate = {0.0, 9.0, 0.0};
  d.contact.exclude = {{"b", "a"}, {"a", "b"}, {"a", "a"}, {"a[1,0,0]", "b"}};
  const Model m = build(d);
  EXPECT_EQ(m.excluded_pairs, (std::vector<std::pair<Index, Index>>{{0, 0}, {0, 2}, {1, 1}, {1, 2}}));
  EXPECT_FALSE(m.can_touch(2, 0));
  EXPECT_FALSE(m.can_touch(0, 0));
  EXPECT_TRUE(m.can_touch(0, 1));
  EXPECT_TRUE(m.can_touch(2, 2));
}

TEST(build_model, contact_switches_decide_who_can_touch) {
  Description d = one_body(CubedSphere{1.0, 2});
  add_body(d, "b", CubedSphere{1.0, 2}).translate = {0.0, 9.0, 0.0};
  d.contact.enabled = true;
  d.contact.self = false;
  const Model m = build(d);
  EXPECT_FALSE(m.can_touch(1, 1));
  EXPECT_TRUE(m.can_touch(1, 0));
  d.contact.enabled = false;
  EXPECT_FALSE(build(d).can_touch(1, 0));
}

TEST(build_model, a_curve_is_linear_between_points_and_constant_beyond) {
  Model m;
  m.curves.push_back({"c", {{1.0, 10.0}, {2.0, 20.0}, {4.0, 0.0}, {4.0, 5.0}}, {}});
  m.curves.push_back({"point", {{1.0, 3.0}}, {}});
  EXPECT_EQ(curve_value(m, no_index, 5.0), 1.0);
  EXPECT_EQ(curve_value(m, 0, -1.0), 10.0);
  EXPECT_EQ(curve_value(m, 0, 1.0), 10.0);
  EXPECT_EQ(curve_value(m, 0, 1.25), 12.5);
  EXPECT_EQ(curve_value(m, 0, 2.0), 20.0);
  EXPECT_EQ(curve_value(m, 0, 3.0), 10.0);
  EXPECT_EQ(curve_value(m, 0, 4.0), 5.0);  // A jump takes its later value.
  EXPECT_EQ(curve_value(m, 0, 9.0), 5.0);
  EXPECT_EQ(curve_value(m, 1, 0.0), 3.0);
  EXPECT_EQ(curve_value(m, 1, 2.0), 3.0);
}

}  // namespace
}  // namespace fexp::model
