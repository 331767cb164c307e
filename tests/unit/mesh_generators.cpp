// SPDX-License-Identifier: Apache-2.0
#include "model/mesh_generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "model/topology.hpp"

namespace fexp::model {
namespace {

constexpr double pi = std::numbers::pi;

Vec3d area_vector(const Mesh& mesh, const Triangle& t) {
  const Vec3d& a = mesh.position[at(t[0])];
  return 0.5 * cross(mesh.position[at(t[1])] - a, mesh.position[at(t[2])] - a);
}

Vec3d centroid(const Mesh& mesh, const Triangle& t) {
  return (1.0 / 3.0) * (mesh.position[at(t[0])] + mesh.position[at(t[1])] + mesh.position[at(t[2])]);
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangle) {
    sum += norm(area_vector(mesh, t));
  }
  return sum;
}

/// Enclosed volume by the divergence theorem; right for closed meshes whose normals point outwards.
double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangle) {
    sum += dot(centroid(mesh, t), area_vector(mesh, t)) / 3.0;
  }
  return sum;
}

long euler_characteristic(const Mesh& mesh) {
  const std::vector<Triangle> neighbours = edge_neighbours(mesh.triangle);
  long free_edges = 0;
  for (const Triangle& n : neighbours) {
    for (const Index other : n) {
      free_edges += other == no_index ? 1 : 0;
    }
  }
  const auto triangles = static_cast<long>(mesh.triangle.size());
  const long edges = (3 * triangles - free_edges) / 2 + free_edges;
  return static_cast<long>(mesh.position.size()) - edges + triangles;
}

double longest_over_shortest_edge(const Mesh& mesh) {
  double low = HUGE_VAL, high = 0.0;
  for (const Triangle& t : mesh.triangle) {
    for (std::size_t e = 0; e < 3; ++e) {
      const double length = norm(mesh.position[at(t[(e + 1) % 3])] - mesh.position[at(t[e])]);
      low = std::min(low, length);
      high = std::max(high, length);
    }
  }
  return high / low;
}

struct Expected {
  MeshGenerator generator;
  std::size_t triangles;
  std::size_t nodes;
  long euler;  // 2 sphere, 1 disk, 0 tube
  bool closed;
};

std::vector<Expected> cases() {
  std::vector<Expected> list;
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 8U}) {
    list.push_back({CubedSphere{1.0, static_cast<int>(n)}, 12 * n * n, 6 * n * n + 2, 2, true});
  }
  list.push_back({UvSphere{1.0, 3, 2}, 6, 5, 2, true});
  list.push_back({UvSphere{2.0, 12, 7}, 144, 74, 2, true});
  list.push_back({Plate{1.0, 2.0, 3, 4, "one"}, 24, 20, 1, false});
  list.push_back({Plate{1.0, 2.0, 3, 4, "alternating"}, 24, 20, 1, false});
  list.push_back({Plate{1.0, 2.0, 3, 4, "crossed"}, 48, 32, 1, false});
  list.push_back({Plate{1.0, 2.0, 3, 4, "one", 90.0}, 24, 20, 1, false});
  list.push_back({SphericalCap{1.0, 30.0, 5}, 50, 36, 1, false});
  list.push_back({SphericalCap{1.0, 120.0, 8}, 128, 81, 1, false});
  list.push_back({Cylinder{1.0, 3.0, 12, 5, 360.0}, 120, 72, 0, false});
  list.push_back({Cylinder{1.0, 3.0, 3, 1, 360.0}, 6, 6, 0, false});
  list.push_back({Cylinder{1.0, 3.0, 12, 5, 90.0}, 120, 78, 1, false});
  list.push_back({SquareTube{1.0, 3.0, 4, 5}, 160, 96, 0, false});
  list.push_back({SquareTube{1.0, 3.0, 1, 1}, 8, 8, 0, false});
  list.push_back({OpenBox{1.0, 2.0, 3.0, 2, 3, 4}, 2 * (6 + 2 * 8 + 2 * 12), 52, 1, false});
  return list;
}

TEST(mesh_generators, give_the_triangles_and_nodes_that_their_formulas_say) {
  for (const Expected& c : cases()) {
    const Mesh mesh = generate_mesh(c.generator);
    EXPECT_EQ(mesh.triangle.size(), c.triangles) << "generator " << c.generator.index();
    EXPECT_EQ(mesh.position.size(), c.nodes) << "generator " << c.generator.index();
    EXPECT_EQ(triangle_count(c.generator), static_cast<double>(c.triangles)) << "generator " << c.generator.index();
    EXPECT_EQ(mesh.part.size(), c.triangles);
    EXPECT_EQ(mesh.part_names.size(), 1U);
  }
}

TEST(mesh_generators, the_paper_sphere_has_192_triangles_and_98_nodes) {
  const Mesh mesh = generate_mesh(CubedSphere{0.1, 4});
  EXPECT_EQ(mesh.triangle.size(), 192U);
  EXPECT_EQ(mesh.position.size(), 98U);
}

TEST(mesh_generators, every_mesh_passes_the_checks_has_its_topology_and_one_side) {
  for (const Expected& c : cases()) {
    const Mesh mesh = generate_mesh(c.generator);
    ErrorList errors;
    check_mesh(mesh, {}, "body", errors);
    EXPECT_TRUE(errors.empty()) << errors.errors().front().text();
    EXPECT_EQ(euler_characteristic(mesh), c.euler) << "generator " << c.generator.index();
    EXPECT_EQ(boundary_nodes(mesh.triangle).empty(), c.closed);
    std::vector<Triangle> oriented = mesh.triangle;
    std::vector<Triangle> neighbours = edge_neighbours(oriented);
    ASSERT_TRUE(orient_consistently(oriented, neighbours));
    EXPECT_EQ(oriented, mesh.triangle) << "generator " << c.generator.index();
  }
}

// Every compiler has to number nodes alike: calls as arguments of one function may be evaluated in any order.
TEST(mesh_generators, number_nodes_cell_by_cell_going_round_each) {
  const auto first_triangles = [](const MeshGenerator& generator) {
    const Mesh mesh = generate_mesh(generator);
    return std::vector<Triangle>(mesh.triangle.begin(), mesh.triangle.begin() + 4);
  };
  EXPECT_EQ(first_triangles(CubedSphere{1.0, 4}), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
  EXPECT_EQ(first_triangles(UvSphere{1.0, 6, 4}), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
  EXPECT_EQ(first_triangles(Plate{1.0, 1.0, 3, 3, "one"}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
  EXPECT_EQ(first_triangles(Cylinder{1.0, 1.0, 6, 2, 360.0}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
  EXPECT_EQ(first_triangles(SquareTube{1.0, 1.0, 2, 2}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {4, 5, 2}}));
  EXPECT_EQ(first_triangles(OpenBox{1.0, 1.0, 1.0, 2, 2, 2}),
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {4, 5, 2}}));
}

TEST(mesh_generators, no_two_nodes_coincide) {
  for (const Expected& c : cases()) {
    const Mesh mesh = generate_mesh(c.generator);
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GT(norm(mesh.position[i] - mesh.position[j]), 1e-3) << "generator " << c.generator.index();
      }
    }
  }
}

TEST(mesh_generators, normals_point_outwards_or_up) {
  const auto expect_along = [](const MeshGenerator& generator, auto direction) {
    const Mesh mesh = generate_mesh(generator);
    for (const Triangle& t : mesh.triangle) {
      EXPECT_GT(dot(area_vector(mesh, t), direction(centroid(mesh, t))), 0.0) << "generator " << generator.index();
    }
  };
  const auto from_centre = [](const Vec3d& p) { return p; };
  const auto from_axis = [](const Vec3d& p) { return Vec3d{p.x, p.y, 0.0}; };
  expect_along(CubedSphere{2.0, 5}, from_centre);
  expect_along(UvSphere{2.0, 9, 6}, from_centre);
  expect_along(SphericalCap{2.0, 50.0, 6}, from_centre);
  expect_along(Plate{1.0, 1.0, 3, 2, "crossed"}, [](const Vec3d&) { return Vec3d{0.0, 0.0, 1.0}; });
  expect_along(Cylinder{1.0, 2.0, 7, 3, 360.0}, from_axis);
  expect_along(Cylinder{1.0, 2.0, 7, 3, 200.0}, from_axis);
  expect_along(SquareTube{1.0, 2.0, 3, 3}, from_axis);
  expect_along(OpenBox{1.0, 2.0, 3.0, 2, 3, 4}, [](const Vec3d& p) {
    return p.z == 0.0 ? Vec3d{0.0, 0.0, -1.0} : Vec3d{p.x, p.y, 0.0};
  });
}

TEST(mesh_generators, a_twisted_plate_turns_evenly_about_its_middle_line) {
  const Mesh flat = generate_mesh(Plate{4.0, 2.0, 4, 2, "one"});
  const Mesh mesh = generate_mesh(Plate{4.0, 2.0, 4, 2, "one", 90.0});
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const Vec3d &p = mesh.position[n], &q = flat.position[n];
    EXPECT_EQ(p.x, q.x);
    const double angle = pi / 2.0 * q.x / 4.0;
    EXPECT_NEAR(p.y, 1.0 + (q.y - 1.0) * std::cos(angle), 1e-15);
    EXPECT_NEAR(p.z, (q.y - 1.0) * std::sin(angle), 1e-15);
  }
}

TEST(mesh_generators, a_cap_lies_on_its_sphere_with_its_rim_at_the_angle_and_a_node_at_the_pole) {
  const Mesh mesh = generate_mesh(SphericalCap{3.0, 40.0, 6});
  for (const Vec3d& p : mesh.position) {
    EXPECT_NEAR(norm(p), 3.0, 1e-14);
  }
  for (const Index n : boundary_nodes(mesh.triangle)) {
    EXPECT_NEAR(mesh.position[at(n)].z, 3.0 * std::cos(40.0 * pi / 180.0), 1e-14);
  }
  EXPECT_EQ(std::count(mesh.position.begin(), mesh.position.end(), Vec3d{0.0, 0.0, 3.0}), 1);
  EXPECT_LT(longest_over_shortest_edge(mesh), 3.0);
}

TEST(mesh_generators, flat_shapes_have_their_exact_areas) {
  EXPECT_NEAR(area(generate_mesh(Plate{2.0, 3.0, 4, 7, "alternating"})), 6.0, 1e-12);
  EXPECT_NEAR(area(generate_mesh(SquareTube{0.5, 3.0, 3, 4})), 6.0, 1e-12);
  EXPECT_NEAR(area(generate_mesh(OpenBox{1.0, 2.0, 3.0, 2, 3, 4})), 2.0 + 2.0 * 3.0 * 3.0, 1e-12);
}

TEST(mesh_generators, curved_shapes_converge_to_their_areas_with_second_order) {
  const auto expect_order_two = [](auto make, double exact) {
    const double coarse = exact - area(generate_mesh(make(8)));
    const double fine = exact - area(generate_mesh(make(16)));
    EXPECT_GT(coarse, 0.0);
    EXPECT_NEAR(coarse / fine, 4.0, 0.1);
  };
  expect_order_two([](int n) { return CubedSphere{2.0, n}; }, 16.0 * pi);
  expect_order_two([](int n) { return UvSphere{2.0, 2 * n, n}; }, 16.0 * pi);
  expect_order_two([](int n) { return Cylinder{1.0, 2.0, 2 * n, n, 360.0}; }, 4.0 * pi);
  expect_order_two([](int n) { return Cylinder{1.0, 2.0, n, n, 90.0}; }, pi);
  expect_order_two([](int n) { return SphericalCap{2.0, 60.0, n}; }, 4.0 * pi);
}

TEST(mesh_generators, spheres_enclose_nearly_the_volume_of_a_sphere) {
  EXPECT_NEAR(volume(generate_mesh(CubedSphere{2.0, 32})), 32.0 * pi / 3.0, 0.05);
  EXPECT_NEAR(volume(generate_mesh(UvSphere{2.0, 128, 64})), 32.0 * pi / 3.0, 0.05);
}

TEST(mesh_generators, nodes_of_the_cubed_sphere_lie_on_the_sphere_and_mirror_exactly) {
  for (const int n : {3, 4, 7}) {
    const Mesh mesh = generate_mesh(CubedSphere{0.7, n});
    std::set<std::tuple<double, double, double>> nodes;
    for (const Vec3d& p : mesh.position) {
      EXPECT_NEAR(norm(p), 0.7, 1e-15);
      nodes.emplace(p.x, p.y, p.z);
    }
    for (const Vec3d& p : mesh.position) {
      EXPECT_TRUE(nodes.contains({-p.x, p.y, p.z}));
      EXPECT_TRUE(nodes.contains({p.x, -p.y, p.z}));
      EXPECT_TRUE(nodes.contains({p.x, p.y, -p.z}));
    }
  }
}

TEST(mesh_generators, triangles_of_the_cubed_sphere_stay_even_when_refined) {
  EXPECT_LT(longest_over_shortest_edge(generate_mesh(CubedSphere{1.0, 4})), 1.9);
  EXPECT_LT(longest_over_shortest_edge(generate_mesh(CubedSphere{1.0, 32})), 2.2);
}

TEST(mesh_generators, shapes_stand_where_the_manual_says) {
  const auto box = [](const MeshGenerator& generator) {
    Box b;
    for (const Vec3d& p : generate_mesh(generator).position) {
      b.include(p);
    }
    return b;
  };
  EXPECT_EQ(box(Plate{2.0, 3.0, 2, 2, "one"}).low, (Vec3d{0.0, 0.0, 0.0}));
  EXPECT_EQ(box(Plate{2.0, 3.0, 2, 2, "one"}).high, (Vec3d{2.0, 3.0, 0.0}));
  EXPECT_EQ(box(SquareTube{2.0, 3.0, 2, 2}).low, (Vec3d{-1.0, -1.0, 0.0}));
  EXPECT_EQ(box(SquareTube{2.0, 3.0, 2, 2}).high, (Vec3d{1.0, 1.0, 3.0}));
  EXPECT_EQ(box(OpenBox{2.0, 4.0, 3.0, 2, 2, 2}).low, (Vec3d{-1.0, -2.0, 0.0}));
  EXPECT_EQ(box(OpenBox{2.0, 4.0, 3.0, 2, 2, 2}).high, (Vec3d{1.0, 2.0, 3.0}));
  EXPECT_EQ(box(Cylinder{2.0, 3.0, 8, 2, 360.0}).low.z, 0.0);
  EXPECT_EQ(box(Cylinder{2.0, 3.0, 8, 2, 360.0}).high.z, 3.0);
}

TEST(mesh_generators, absurd_counts_lie_outside_their_ranges) {
  EXPECT_FALSE(cell_range.contains(1e9));
  EXPECT_FALSE(cell_range.contains(0.0));
  EXPECT_FALSE(ring_range.contains(2.0));
  EXPECT_FALSE(angle_range.contains(0.0));
  EXPECT_GT(triangle_count(CubedSphere{1.0, 10000}), 1e9);
}

}  // namespace
}  // namespace fexp::model
