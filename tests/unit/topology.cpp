// SPDX-License-Identifier: Apache-2.0
#include "model/topology.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "model/branches.hpp"
#include "model/mesh_generators.hpp"

namespace fexp::model {
namespace {

Mesh mesh_of(std::vector<Vec3d> position, std::vector<Triangle> triangle) {
  Mesh mesh;
  mesh.part.assign(triangle.size(), 0);
  mesh.position = std::move(position);
  mesh.triangle = std::move(triangle);
  return mesh;
}

std::vector<std::string> errors_of(const Mesh& mesh) {
  ErrorList errors;
  check_mesh(mesh, {"deck.toml", 3, 1}, "ball", errors);
  std::vector<std::string> texts;
  for (const InputError& error : errors.errors()) {
    texts.push_back(error.text());
    EXPECT_FALSE(error.cure.empty());
    EXPECT_FALSE(error.accepted.empty());
    EXPECT_NE(error.message.find("\"ball\""), std::string::npos);
    EXPECT_EQ(error.place.line, 3);
  }
  return texts;
}

testing::AssertionResult has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos ? testing::AssertionSuccess()
                                              : testing::AssertionFailure() << '"' << text << "\" lacks " << part;
}

const std::vector<Vec3d> square{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}, {0.5, 0.5, 1.0}};

TEST(topology, neighbours_across_edges_are_mutual_and_share_the_edge) {
  const Mesh mesh = generate_mesh(OpenBox{1.0, 1.0, 1.0, 4, 3, 2});
  const std::vector<Triangle> neighbours = edge_neighbours(mesh.triangle);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    for (std::size_t e = 0; e < 3; ++e) {
      const Index a = mesh.triangle[t][e], b = mesh.triangle[t][(e + 1) % 3];
      std::vector<Index> brute_force;
      for (std::size_t o = 0; o < mesh.triangle.size(); ++o) {
        for (std::size_t f = 0; f < 3; ++f) {
          if (mesh.triangle[o][f] == b && mesh.triangle[o][(f + 1) % 3] == a) {
            brute_force.push_back(static_cast<Index>(o));
          }
        }
      }
      ASSERT_LE(brute_force.size(), 1U);
      EXPECT_EQ(neighbours[t][e], brute_force.empty() ? no_index : brute_force.front());
    }
  }
}

TEST(topology, boundary_of_a_plate_is_its_rim) {
  const Mesh mesh = generate_mesh(Plate{1.0, 1.0, 5, 4, "crossed"});
  std::vector<Index> rim;
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const Vec3d& p = mesh.position[n];
    if (p.x == 0.0 || p.x == 1.0 || p.y == 0.0 || p.y == 1.0) {
      rim.push_back(static_cast<Index>(n));
    }
  }
  EXPECT_EQ(boundary_nodes(mesh.triangle), rim);
}

TEST(topology, corner_rows_list_every_corner_once_ascending_at_its_node) {
  const Mesh mesh = generate_mesh(CubedSphere{1.0, 3});
  const CornerRows rows = corner_rows(static_cast<Index>(mesh.position.size()), mesh.triangle);
  ASSERT_EQ(rows.start.size(), mesh.position.size() + 1);
  ASSERT_EQ(rows.corner.size(), 3 * mesh.triangle.size());
  EXPECT_EQ(rows.start.back(), static_cast<Index>(rows.corner.size()));
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    for (Index i = rows.start[n]; i < rows.start[n + 1]; ++i) {
      const Index corner = rows.corner[at(i)];
      EXPECT_EQ(mesh.triangle[at(corner / 3)][at(corner % 3)], static_cast<Index>(n));
      EXPECT_TRUE(i == rows.start[n] || rows.corner[at(i - 1)] < corner);
    }
  }
}

TEST(topology, turned_triangles_are_turned_back_to_agree_with_the_first_of_their_piece) {
  const Mesh mesh = generate_mesh(CubedSphere{1.0, 6});
  std::vector<Triangle> mixed = mesh.triangle;
  std::mt19937 random(7);
  for (std::size_t t = 1; t < mixed.size(); ++t) {
    if (random() % 2 == 0) {
      std::swap(mixed[t][1], mixed[t][2]);
    }
  }
  ASSERT_NE(mixed, mesh.triangle);
  std::vector<Triangle> neighbours = edge_neighbours(mixed);
  ASSERT_TRUE(orient_consistently(mixed, neighbours));
  EXPECT_EQ(neighbours, edge_neighbours(mixed));
  for (const Triangle& t : mixed) {
    const Vec3d &a = mesh.position[at(t[0])], &b = mesh.position[at(t[1])], &c = mesh.position[at(t[2])];
    EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0.0);
  }
}

TEST(topology, each_separate_piece_keeps_the_side_of_its_own_first_triangle) {
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 3, 2}, {4, 6, 5}, {4, 6, 7}};
  std::vector<Triangle> neighbours = edge_neighbours(triangles);
  ASSERT_TRUE(orient_consistently(triangles, neighbours));
  EXPECT_EQ(triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(triangles[2], (Triangle{4, 6, 5}));
  EXPECT_EQ(triangles[1], (Triangle{0, 2, 3}));
  EXPECT_EQ(triangles[3], (Triangle{4, 7, 6}));
}

TEST(topology, moebius_strip_is_refused_as_having_one_side) {
  std::vector<Vec3d> position;
  std::vector<Triangle> triangle;
  constexpr Index n = 12;
  for (Index i = 0; i < n; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / n;
    for (const double s : {-0.2, 0.2}) {
      const double r = 1.0 + s * std::cos(angle / 2.0);
      position.push_back({r * std::cos(angle), r * std::sin(angle), s * std::sin(angle / 2.0)});
    }
    const bool last = i == n - 1;
    const Index a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
    triangle.push_back({a, c, d});
    triangle.push_back({a, d, b});
  }
  const std::vector<std::string> errors = errors_of(mesh_of(position, triangle));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "Moebius"));
}

TEST(topology, a_good_mesh_gives_no_error) { EXPECT_TRUE(errors_of(generate_mesh(CubedSphere{1.0, 4})).empty()); }

TEST(topology, a_mesh_without_triangles_is_refused) {
  const auto errors = errors_of(mesh_of(square, {}));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "no triangles"));
}

TEST(topology, a_repeated_node_and_a_triangle_without_area_are_named_with_their_labels) {
  Mesh mesh = mesh_of(square, {{0, 1, 2}, {0, 0, 3}, {0, 2, 3}});
  mesh.triangle_label = {101, 102, 103};
  auto errors = errors_of(mesh);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "repeated node: 102"));
  mesh = mesh_of({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {3.0, 3.0, 3.0}}, {{0, 1, 2}});
  mesh.triangle_label = {77};
  errors = errors_of(mesh);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "without area: 77"));
}

TEST(topology, a_small_triangle_of_good_shape_is_no_degenerate_one) {
  EXPECT_TRUE(errors_of(mesh_of({{0.0, 0.0, 0.0}, {1e-9, 0.0, 0.0}, {0.0, 1e-9, 0.0}}, {{0, 1, 2}})).empty());
}

TEST(topology, an_edge_of_more_triangles_than_may_meet_is_refused_with_their_names) {
  std::vector<Vec3d> position{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  std::vector<Triangle> triangle;
  for (Index i = 0; i < most_at_edge; ++i) {
    position.push_back({std::cos(0.7 * i), std::sin(0.7 * i), 0.5});
    triangle.push_back({0, 1, i + 2});
  }
  EXPECT_TRUE(errors_of(mesh_of(position, triangle)).empty());
  position.push_back({2.0, 2.0, 0.5});
  triangle.push_back({1, 0, most_at_edge + 2});
  const auto errors = errors_of(mesh_of(position, triangle));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "more than 8 triangles"));
  EXPECT_TRUE(has(errors[0], "0-1-2"));
}

TEST(topology, duplicate_triangles_are_refused_whatever_their_orientation) {
  for (const Triangle& twin : {Triangle{0, 1, 2}, Triangle{1, 2, 0}, Triangle{0, 2, 1}}) {
    const auto errors = errors_of(mesh_of(square, {{0, 1, 2}, twin}));
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_TRUE(has(errors[0], "same nodes: 0 = 1"));
  }
}

TEST(topology, nodes_out_of_range_and_coordinates_that_are_no_numbers_are_refused) {
  EXPECT_TRUE(has(errors_of(mesh_of(square, {{0, 1, 9}})).at(0), "names a node that is not there"));
  EXPECT_TRUE(has(errors_of(mesh_of(square, {{0, 1, -1}})).at(0), "names a node that is not there"));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<Vec3d> position = square;
    position[2].y = bad;
    EXPECT_TRUE(has(errors_of(mesh_of(position, {{0, 1, 2}})).at(0), "finite"));
  }
}

TEST(topology, of_many_culprits_five_are_named_and_the_rest_counted) {
  const auto errors = errors_of(mesh_of(square, std::vector<Triangle>(8, {0, 0, 1})));
  ASSERT_GE(errors.size(), 1U);
  EXPECT_TRUE(has(errors[0], "0, 1, 2, 3, 4 and 3 more"));
}

}  // namespace
}  // namespace fexp::model
