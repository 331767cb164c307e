// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "base/orientation.hpp"
#include "model/mesh_generators.hpp"
#include "quality/crossing_watch.hpp"
#include "support/contact.hpp"

/// Edges through triangles, and nodes that have passed through surfaces, as `fexp crossings` counts them.
namespace fexp::quality {
namespace {

using Points = std::vector<Vec3d>;

/// Several meshes, each a body.
struct Bodies {
  explicit Bodies(const std::vector<model::Mesh>& meshes) {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> node_body;
    for (const model::Mesh& mesh : meshes) {
      const auto first = static_cast<Index>(position.size());
      for (const auto& t : mesh.triangle) {
        triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
      node_body.insert(node_body.end(), mesh.position.size(), static_cast<Index>(begin.size()));
      begin.push_back(first);
      position.insert(position.end(), mesh.position.begin(), mesh.position.end());
    }
    surfaces = std::make_unique<Surfaces>(std::move(triangles), std::move(node_body), static_cast<Index>(begin.size()));
    begin.push_back(static_cast<Index>(position.size()));
    alive.assign(surfaces->triangle.size(), 1);
  }

  /// The positions with those of a body moved.
  [[nodiscard]] Points moved(std::size_t body, const Vec3d& by) const {
    Points points = position;
    for (Index n = begin[body]; n < begin[body + 1]; ++n) {
      points[at(n)] += by;
    }
    return points;
  }

  [[nodiscard]] std::size_t nodes_of(std::size_t body) const { return at(begin[body + 1] - begin[body]); }

  Points position;
  std::vector<Index> begin;  // First node of each body
  std::vector<char> alive;
  std::unique_ptr<Surfaces> surfaces;
};

model::Mesh shifted(model::Mesh mesh, const Vec3d& by) {
  for (Vec3d& x : mesh.position) {
    x += by;
  }
  return mesh;
}

model::Mesh flat(double length, int cells, const Vec3d& corner) {
  return shifted(model::generate_mesh(test::plate(length, length, cells, cells)), corner);
}

model::Mesh ball(double radius, int cells, const Vec3d& centre) {
  return shifted(model::generate_mesh(model::CubedSphere{radius, cells}), centre);
}

TEST(edge_through_triangle, is_told_from_one_that_touches_or_is_beside) {
  const std::array<Vec3d, 3> t{Vec3d{0.0, 0.0, 0.0}, Vec3d{1.0, 0.0, 0.0}, Vec3d{0.0, 1.0, 0.0}};
  EXPECT_TRUE(goes_through({0.2, 0.2, -1.0}, {0.2, 0.2, 1.0}, t));
  EXPECT_TRUE(goes_through({0.2, 0.2, 1.0}, {0.2, 0.2, -1.0}, t));
  EXPECT_FALSE(goes_through({0.8, 0.8, -1.0}, {0.8, 0.8, 1.0}, t));
  EXPECT_FALSE(goes_through({0.2, 0.2, 0.5}, {0.2, 0.2, 1.0}, t));
  EXPECT_FALSE(goes_through({0.2, 0.2, 0.0}, {0.2, 0.2, 1.0}, t)) << "ends in the plane";
  EXPECT_FALSE(goes_through({-1.0, 0.2, 0.0}, {1.0, 0.2, 0.0}, t)) << "lies in the plane";
  EXPECT_TRUE(goes_through({0.5, 0.5, -1.0}, {0.5, 0.5, 1.0}, t)) << "through the rim";
  EXPECT_TRUE(goes_through({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, t)) << "through a corner";
  EXPECT_FALSE(goes_through({std::nextafter(0.5, 1.0), 0.5, -1.0}, {std::nextafter(0.5, 1.0), 0.5, 1.0}, t));
  EXPECT_TRUE(goes_through({0.2, 0.2, -1e-300}, {0.2, 0.2, 1e-300}, t));
}

TEST(edges_through_triangles, are_those_of_trying_every_pair) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.4, 0.4);
  for (int scene = 0; scene < 20; ++scene) {
    std::vector<model::Mesh> meshes{ball(0.5, 3, {}), ball(0.3, 4, {shift(random), shift(random), shift(random)}),
                                    flat(1.0, 6, {shift(random) - 0.5, shift(random) - 0.5, shift(random)})};
    test::shake(meshes[2], 0.1, static_cast<unsigned>(scene));
    Bodies bodies(meshes);
    // Half of the triangles of the last body are gone, in the odd scenes.
    for (std::size_t t = 0; scene % 2 == 1 && t < bodies.alive.size(); ++t) {
      bodies.alive[t] = bodies.surfaces->body_of_triangle(static_cast<Index>(t)) == 2 && t % 2 == 0 ? 0 : 1;
    }
    const Surfaces& s = *bodies.surfaces;
    std::vector<EdgeCut> expected;
    for (std::size_t e = 0; e < s.edge.size(); ++e) {
      const auto& nodes = s.edge[e];
      bool edge_alive = false;
      for (std::size_t t = 0; t < s.triangle.size(); ++t) {
        edge_alive = edge_alive || (bodies.alive[t] != 0 && std::ranges::count(s.triangle_edges[t], Index(e)) > 0);
      }
      for (std::size_t t = 0; edge_alive && t < s.triangle.size(); ++t) {
        const auto& corner = s.triangle[t];
        const Vec3d &a = bodies.position[at(corner[0])], &b = bodies.position[at(corner[1])],
                    &c = bodies.position[at(corner[2])], &p = bodies.position[at(nodes[0])],
                    &q = bodies.position[at(nodes[1])];
        const auto volume = [](const Vec3d& u, const Vec3d& v, const Vec3d& w, const Vec3d& x) {
          return dot(cross(v - u, w - u), x - u);
        };
        const double x = volume(p, q, a, b), y = volume(p, q, b, c), z = volume(p, q, c, a);
        if (bodies.alive[t] != 0 && std::ranges::count(corner, nodes[0]) + std::ranges::count(corner, nodes[1]) == 0 &&
            volume(a, b, c, p) * volume(a, b, c, q) < 0.0 && x * y > 0.0 && y * z > 0.0) {
          expected.push_back({static_cast<Index>(e), static_cast<Index>(t)});
        }
      }
    }
    EXPECT_EQ(find_edge_cuts(s, bodies.position, bodies.alive), expected) << scene;
    EXPECT_FALSE(expected.empty()) << scene;
  }
}

TEST(edges_through_triangles, are_none_in_meshes_as_they_are_made_and_where_bodies_lie_side_by_side) {
  const Bodies bodies({flat(1.0, 8, {}), ball(0.5, 5, {0.3, 0.4, 2.0}),
                       shifted(model::generate_mesh(model::OpenBox{1.0, 1.0, 1.0, 4, 4, 4}), {5.0, 0.0, 0.0}),
                       shifted(model::generate_mesh(model::OpenBox{1.0, 1.0, 1.0, 4, 4, 4}), {6.0, 0.0, 0.0}),
                       flat(1.0, 3, {0.9, 0.1, 0.0})});
  EXPECT_TRUE(find_edge_cuts(*bodies.surfaces, bodies.position, bodies.alive).empty());
}

TEST(edges_through_triangles, are_found_within_a_body) {
  // A plate whose two halves fold back through each other.
  Bodies bodies({flat(1.0, 4, {})});
  EXPECT_TRUE(find_edge_cuts(*bodies.surfaces, bodies.position, bodies.alive).empty());
  for (Vec3d& x : bodies.position) {
    if (x.x > 0.6) {
      x = {0.9 - 0.5 * x.x, x.y + 0.01, x.x > 0.9 ? -0.1 : 0.1};
    }
  }
  EXPECT_FALSE(find_edge_cuts(*bodies.surfaces, bodies.position, bodies.alive).empty());
}

/// Whether a point is in a convex body whose triangles point outwards.
bool is_inside(const Surfaces& s, const Points& position, const Vec3d& x) {
  return std::ranges::all_of(s.triangle, [&](const auto& t) {
    return orientation(position[at(t[0])], position[at(t[1])], position[at(t[2])], x) < 0;
  });
}

int passages(const Surfaces& s, const Points& before, const Points& after, const Vec3d& from, const Vec3d& to) {
  int sum = 0;
  for (const auto& t : s.triangle) {
    MovingTriangle moving{{}, {}, t};
    for (std::size_t i = 0; i < 3; ++i) {
      moving.before[i] = before[at(t[i])];
      moving.after[i] = after[at(t[i])];
    }
    sum += sum_of_passages(from, to, moving);
  }
  return sum;
}

TEST(node_passages, through_a_closed_surface_are_the_change_of_inside_whatever_it_does_between_frames) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int in = 0, out = 0;
  for (const int cells : {1, 2, 4}) {
    const Bodies bodies({ball(0.7, cells, {})});
    for (int i = 0; i < 2000; ++i) {
      // Turned by any angle, squeezed and shifted: it stays convex.
      const Vec3d e{any(random), any(random), any(random)}, shift{any(random), any(random), any(random)};
      const Vec3d axis = (1.0 / norm(e)) * e;
      const double angle = 3.2 * any(random), squeeze = 0.6 + 0.4 * any(random);
      Points after = bodies.position;
      for (Vec3d& x : after) {
        x = std::cos(angle) * x + std::sin(angle) * cross(axis, x) + ((1.0 - std::cos(angle)) * dot(axis, x)) * axis;
        x = {squeeze * x.x, x.y, x.z};
        x += 0.5 * shift;
      }
      const Vec3d from{any(random), any(random), any(random)}, to{any(random), any(random), any(random)};
      const int change = static_cast<int>(is_inside(*bodies.surfaces, bodies.position, from)) -
                         static_cast<int>(is_inside(*bodies.surfaces, after, to));
      ASSERT_EQ(passages(*bodies.surfaces, bodies.position, after, from, to), change) << cells << " " << i;
      in += change < 0 ? 1 : 0;
      out += change > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(in, 300);
  EXPECT_GT(out, 300);
}

TEST(node_passages, are_counted_once_where_the_way_meets_edges_and_corners_exactly) {
  // A cube in whole numbers, and ways along the grid.
  const Bodies bodies({ball(1.0, 2, {})});
  Points cube = bodies.position;
  for (Vec3d& x : cube) {
    x = {std::round(2.0 * x.x), std::round(2.0 * x.y), std::round(2.0 * x.z)};
  }
  std::mt19937 random(9);
  std::uniform_int_distribution<int> any(-4, 4);
  const auto is_on = [&](const Vec3d& x) {
    return !is_inside(*bodies.surfaces, cube, x) && std::ranges::none_of(bodies.surfaces->triangle, [&](const auto& t) {
      return orientation(cube[at(t[0])], cube[at(t[1])], cube[at(t[2])], x) > 0;
    });
  };
  int changes = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d from{double(any(random)), double(any(random)), double(any(random))},
        to{double(any(random)), double(any(random)), double(any(random))},
        shift{double(any(random)), double(any(random)), double(any(random))};
    Points after = cube;
    for (Vec3d& x : after) {
      x += shift;
    }
    if (is_on(from) || is_on(to - shift)) {
      continue;
    }
    const int change = static_cast<int>(is_inside(*bodies.surfaces, cube, from)) -
                       static_cast<int>(is_inside(*bodies.surfaces, cube, to - shift));
    ASSERT_EQ(passages(*bodies.surfaces, cube, after, from, to), change) << i;
    changes += change != 0 ? 1 : 0;
  }
  EXPECT_GT(changes, 50);
}

TEST(crossing_watch, counts_nodes_that_pass_an_open_surface_and_not_those_that_go_round_it) {
  const Bodies bodies({flat(1.0, 4, {}), ball(0.1, 2, {0.52, 0.43, 0.3})});
  const auto all = static_cast<std::ptrdiff_t>(bodies.nodes_of(1));
  for (const bool round : {false, true}) {
    CrossingWatch watch(*bodies.surfaces);
    EXPECT_TRUE(watch.look(bodies.position, bodies.alive).through.empty());
    if (round) {
      EXPECT_TRUE(watch.look(bodies.moved(1, {1.0, 0.0, 0.0}), bodies.alive).through.empty());
      EXPECT_TRUE(watch.look(bodies.moved(1, {1.0, 0.0, -0.6}), bodies.alive).through.empty());
    }
    const FrameCrossings behind = watch.look(bodies.moved(1, {0.0, 0.0, -0.6}), bodies.alive);
    EXPECT_TRUE(behind.cuts.empty());
    EXPECT_EQ(std::ssize(behind.through), round ? 0 : all);
    // It stays so until it comes back the same way.
    EXPECT_EQ(std::ssize(watch.look(bodies.moved(1, {0.1, 0.0, -0.6}), bodies.alive).through), round ? 0 : all);
    const FrameCrossings back = watch.look(bodies.position, bodies.alive);
    EXPECT_EQ(std::ssize(back.through), round ? all : 0);
  }
}

TEST(crossing_watch, sees_the_surface_pass_a_node_and_not_the_other_way_about) {
  // A plate passes over a ball: its nodes, and the ball's, are on the wrong side of each other while it is within.
  const Bodies bodies({flat(0.2, 1, {-0.1, -0.1, 0.7}), ball(0.5, 4, {})});
  CrossingWatch watch(*bodies.surfaces);
  (void)watch.look(bodies.position, bodies.alive);
  const FrameCrossings within = watch.look(bodies.moved(0, {0.0, 0.0, -0.7}), bodies.alive);
  EXPECT_TRUE(within.cuts.empty());
  const auto of_plate = std::ranges::count(within.through, 1, &NodePassage::body);
  EXPECT_EQ(of_plate, 4);
  EXPECT_EQ(std::ssize(within.through) - of_plate, 1) << "the node at the pole";
  // Beyond, the plate's nodes are outside again, and what the plate has passed in all stays passed.
  const FrameCrossings beyond = watch.look(bodies.moved(0, {0.0, 0.0, -1.4}), bodies.alive);
  EXPECT_EQ(std::ranges::count(beyond.through, 1, &NodePassage::body), 0);
  EXPECT_EQ(std::ssize(beyond.through), 2) << "the nodes at both poles";
}

TEST(crossing_watch, lets_come_out_what_is_through_at_the_start) {
  const Bodies bodies({flat(1.0, 4, {}), ball(0.1, 2, {0.52, 0.43, 0.03})});
  CrossingWatch watch(*bodies.surfaces);
  const FrameCrossings first = watch.look(bodies.position, bodies.alive);
  EXPECT_FALSE(first.cuts.empty());
  EXPECT_TRUE(first.new_cuts.empty());
  const FrameCrossings same = watch.look(bodies.position, bodies.alive);
  EXPECT_EQ(same.cuts, first.cuts);
  EXPECT_TRUE(same.new_cuts.empty());
  const FrameCrossings elsewhere = watch.look(bodies.moved(1, {0.3, 0.3, 0.0}), bodies.alive);
  EXPECT_FALSE(elsewhere.new_cuts.empty());
  const FrameCrossings out = watch.look(bodies.moved(1, {0.0, 0.0, 0.3}), bodies.alive);
  EXPECT_TRUE(out.cuts.empty());
  EXPECT_TRUE(out.through.empty());
  // It is free now, so what it passes counts.
  EXPECT_EQ(watch.look(bodies.moved(1, {0.0, 0.0, -0.3}), bodies.alive).through.size(), bodies.nodes_of(1));
}

TEST(crossing_watch, leaves_out_elements_that_have_failed_and_nodes_that_have_none_left) {
  Bodies bodies({flat(1.0, 4, {}), ball(0.1, 2, {0.52, 0.43, 0.3})});
  const Points through = bodies.moved(1, {0.0, 0.0, -0.6}), half = bodies.moved(1, {0.0, 0.0, -0.3});
  std::vector<char> holed = bodies.alive, without_ball = bodies.alive;
  for (std::size_t t = 0; t < holed.size(); ++t) {
    (bodies.surfaces->body_of_triangle(static_cast<Index>(t)) == 0 ? holed[t] : without_ball[t]) = 0;
  }
  CrossingWatch watch(*bodies.surfaces);
  (void)watch.look(bodies.position, bodies.alive);
  EXPECT_TRUE(watch.look(half, holed).cuts.empty());
  EXPECT_TRUE(watch.look(through, holed).through.empty());
  CrossingWatch other(*bodies.surfaces);
  (void)other.look(bodies.position, bodies.alive);
  EXPECT_FALSE(other.look(through, bodies.alive).through.empty());
  EXPECT_TRUE(other.look(through, without_ball).through.empty());
}

}  // namespace
}  // namespace fexp::quality
