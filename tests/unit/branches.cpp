// SPDX-License-Identifier: Apache-2.0
#include "model/branches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "support/contact.hpp"

namespace fexp::model {
namespace {

/// A flange of two triangles along the y axis, the one at x > 0 turned or not, and a web below.
Mesh flange_and_web(bool turned) {
  Mesh mesh;
  mesh.position = {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-1.0, 0.5, 0.0}, {1.0, 0.5, 0.1}, {0.0, 0.5, -1.0}};
  mesh.triangle = {{0, 1, 4}, {0, 1, 2}, turned ? Triangle{0, 1, 3} : Triangle{1, 0, 3}};
  mesh.part.assign(3, 0);
  return mesh;
}

Surface surface_of(const Mesh& mesh) {
  ErrorList errors;
  Surface surface = check_mesh(mesh, {"deck.toml", 1, 1}, "body", errors);
  EXPECT_TRUE(errors.empty());
  return surface;
}

TEST(branches, two_that_go_on_straight_are_neighbours_and_agree_and_the_third_ends_there) {
  int agreed = 0;
  for (const bool turned : {false, true}) {
    const Surface surface = surface_of(flange_and_web(turned));
    EXPECT_TRUE(surface.branched);
    EXPECT_EQ(surface.neighbour[0], (Triangle{no_index, no_index, no_index}));
    EXPECT_EQ(surface.neighbour[1][0], 2);
    EXPECT_EQ(surface.triangle[1], (Triangle{0, 1, 2}));
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const bool back = surface.triangle[2][edge] == 1 && surface.triangle[2][(edge + 1) % 3] == 0;
      EXPECT_EQ(surface.neighbour[2][edge], back ? 1 : no_index);
      agreed += back ? 1 : 0;
    }
  }
  EXPECT_EQ(agreed, 2);
}

TEST(branches, are_none_in_a_surface_of_two_triangles_at_each_edge) {
  EXPECT_FALSE(surface_of(generate_mesh(CubedSphere{1.0, 3})).branched);
}

TEST(branches, rounds_lead_from_each_edge_through_all_between_the_same_nodes_and_back) {
  const Mesh mesh = flange_and_web(false);
  const std::vector<Index> next = edge_rounds(mesh.triangle);
  ASSERT_EQ(next.size(), 9U);
  std::set<Index> round;
  for (Index edge = next[0]; round.insert(edge).second; edge = next[at(edge)]) {
  }
  EXPECT_EQ(round, (std::set<Index>{0, 3, 6}));
  for (const Index alone : {1, 2, 4, 5, 7, 8}) {
    EXPECT_EQ(next[at(alone)], alone);
  }
}

TEST(branches, fans_have_the_corners_that_neighbours_lead_to) {
  const Surface surface = surface_of(flange_and_web(false));
  const std::vector<Index> fan = corner_fans(surface.triangle, surface.neighbour);
  // The flange's corners at nodes 0 and 1; the web's are by themselves.
  EXPECT_EQ(fan[3], fan[7]);
  EXPECT_EQ(fan[4], fan[6]);
  EXPECT_NE(fan[3], fan[0]);
  EXPECT_NE(fan[4], fan[1]);
  const Mesh ball = generate_mesh(CubedSphere{1.0, 3});
  const std::vector<Index> closed = corner_fans(ball.triangle, edge_neighbours(ball.triangle));
  std::vector<Index> of_node(ball.position.size(), no_index);
  for (Index corner = 0; corner < static_cast<Index>(closed.size()); ++corner) {
    Index& first = of_node[at(ball.triangle[at(corner / 3)][at(corner % 3)])];
    first = first == no_index ? corner : first;
    EXPECT_EQ(closed[at(corner)], first);
  }
}

/// A Moebius strip with a fin at one of its edges: cut there, it has two sides.
TEST(branches, that_leave_no_common_side_are_no_neighbours) {
  Mesh mesh;
  constexpr Index n = 12;
  for (Index i = 0; i < n; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / n;
    for (const double s : {-0.2, 0.2}) {
      const double r = 1.0 + s * std::cos(angle / 2.0);
      mesh.position.push_back({r * std::cos(angle), r * std::sin(angle), s * std::sin(angle / 2.0)});
    }
    const bool last = i == n - 1;
    const Index a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
    mesh.triangle.push_back({a, c, d});
    mesh.triangle.push_back({a, d, b});
  }
  mesh.position.push_back({1.0, 0.0, 1.0});
  mesh.triangle.push_back({0, 1, 2 * n});
  mesh.part.assign(mesh.triangle.size(), 0);
  const Surface surface = surface_of(mesh);
  EXPECT_TRUE(surface.branched);
  EXPECT_EQ(surface.neighbour, edge_neighbours(surface.triangle));
}

TEST(branches, of_a_model_are_no_free_edges_and_no_boundary) {
  auto d = test::description(test::rubber, 0.01);
  test::add_body(d, "profile", CubedSphere{});
  d.node_sets.emplace_back();
  d.node_sets.back().name = "rim";
  d.node_sets.back().boundary = true;
  const Model model = test::build(d, {flange_and_web(false)});
  ASSERT_FALSE(model.next_at_edge.empty());
  int free = 0, met = 0;
  for (Index edge = 0; edge < 9; ++edge) {
    free += model.is_free_edge(edge) ? 1 : 0;
    for_each_at_edge(model, edge, [&](Index) { ++met; });
  }
  EXPECT_EQ(free, 6);
  EXPECT_EQ(met, 6);
  // Its middle edge is on the way round all three rims, so every node is on one.
  EXPECT_EQ(boundary_nodes(model.triangle).size(), 5U);
}

}  // namespace
}  // namespace fexp::model
