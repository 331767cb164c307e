// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/contact.hpp"

/// Forces of one node on a surface that is held still.
namespace fexp {
namespace {

using test::Tip;

model::Mesh flat(int cells, const char* diagonals = "one") {
  return model::generate_mesh(test::plate(cells, cells, cells, cells, diagonals));
}

model::Mesh bumpy(int cells, double height, unsigned seed) {
  model::Mesh m = flat(cells);
  test::shake(m, height, seed);
  return m;
}

/// Two square faces of side 4 that meet at the y axis and fall away from it on both sides by `angle` [rad], or rise
/// where it is negative; normals upwards.
model::Mesh fold(double angle) {
  model::Mesh m = model::generate_mesh(test::plate(8.0, 4.0, 8, 4));
  for (Vec3d& x : m.position) {
    const double way = x.x - 4.0;
    x = {way * std::cos(angle), x.y, -std::abs(way) * std::sin(angle)};
  }
  return m;
}

TEST(contact_force, is_the_gradient_of_the_energy_over_face_edge_and_corner_and_from_behind) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.8, 4.2), near(-0.1, 0.1), height(0.02, 0.28);
  int pushed = 0, from_behind = 0, edges = 0, corners = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Tip tip(bumpy(5, 0.25, seed), 0.3);
    // The energy has no other slope only where the stiffness is the same all over.
    std::fill(tip.model.contact_stiffness.begin(), tip.model.contact_stiffness.end(), 1.0e5);
    for (int i = 0; i < 60; ++i) {
      // Every other time near a node, where the closest point is often a corner.
      const Vec3d& corner = tip.model.reference_position[at(static_cast<Index>(7 + 6 * (i % 4) + i % 3))];
      const double x = i % 2 == 0 ? place(random) : corner.x + near(random);
      const double y = i % 2 == 0 ? place(random) : corner.y + near(random), behind = i % 3 == 0 ? -1.0 : 1.0;
      tip.memory.clear();
      tip.move({x, y, 0.8});
      tip.move({x, y, 0.3});
      tip.move({x, y, behind * height(random)});
      tip.energy();
      const std::vector<contact::ActivePair> pairs = tip.active;
      if (pairs.empty()) {
        continue;
      }
      const double scale = norm(pairs[0].force);
      constexpr double step = 1e-6;
      const auto slope = [&](Index n) {
        Vec3d gradient;
        for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
          double& coordinate = tip.motion[at(n)].position.*axis;
          const double middle = coordinate;
          coordinate = middle + step;
          const double up = tip.energy();
          coordinate = middle - step;
          const double down = tip.energy();
          coordinate = middle;
          gradient.*axis = (up - down) / (2.0 * step);
        }
        return gradient;
      };
      Vec3d on_node;
      std::vector<Vec3d> on_corners(tip.model.reference_position.size());
      for (const contact::ActivePair& pair : pairs) {
        on_node += pair.force;
        for (std::size_t a = 0; a < 3; ++a) {
          on_corners[at(tip.model.triangle[at(pair.element)][a])] -= pair.weight[a] * pair.force;
        }
      }
      EXPECT_LE(norm(slope(tip.node) + on_node), 2e-5 * scale) << seed << " " << i;
      for (const contact::ActivePair& pair : pairs) {
        for (const Index n : tip.model.triangle[at(pair.element)]) {
          EXPECT_LE(norm(slope(n) + on_corners[at(n)]), 2e-5 * scale) << seed << " " << i;
        }
        ++pushed;
        from_behind += behind < 0.0;
        int zeros = 0;
        for (const double w : pair.weight) {
          zeros += w == 0.0;
        }
        edges += zeros == 1;
        corners += zeros == 2;
      }
    }
  }
  EXPECT_GT(pushed, 200);
  EXPECT_GT(from_behind, 50);
  EXPECT_GT(edges, 20);
  EXPECT_GT(corners, 5);
}

TEST(contact_force, grows_with_the_stiffness_of_the_surface_and_is_the_same_from_either_element_at_an_edge) {
  model::Mesh m = flat(4);
  for (Vec3d& x : m.position) {
    x.x *= x.x;  // cells of growing size
  }
  Tip tip(m, 0.3);
  tip.model.contact_laws.laws[0].hardening = 0.0;
  const auto& k = tip.model.contact_stiffness;
  const auto& x = tip.model.reference_position;
  const auto stiffness_above = [&](const Vec3d& foot) {
    tip.memory.clear();
    for (const double height : {3.0, 0.35, 0.1}) {
      tip.move(foot + Vec3d{0.0, 0.0, height});
    }
    EXPECT_EQ(tip.active.size(), 1U);
    return tip.active.at(0).stiffness;
  };
  for (Index e = 0; e < tip.model.bodies[0].elements.end; ++e) {
    const auto& t = tip.model.triangle[at(e)];
    const Vec3d centre = (1.0 / 3.0) * (x[at(t[0])] + x[at(t[1])] + x[at(t[2])]);
    const double series =
        1.0 / (1.0 / k[at(tip.node)] + (1.0 / k[at(t[0])] + 1.0 / k[at(t[1])] + 1.0 / k[at(t[2])]) / 3);
    EXPECT_NEAR(stiffness_above(centre), series, 1e-12 * series);
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3d middle = 0.5 * (x[at(t[a])] + x[at(t[(a + 1) % 3])]);
      const double at_edge = stiffness_above(middle);
      EXPECT_NEAR(stiffness_above(middle + 1e-8 * (centre - middle)), at_edge, 1e-6 * at_edge);
    }
  }
}

TEST(contact_force, of_a_node_behind_the_surface_pushes_it_back_the_way_it_came_wherever_it_slides_there) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> way(-0.08, 0.08);
  for (const double thickness : {0.005, 0.1}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      Tip tip(bumpy(8, 0.05, seed), thickness);
      const double depth = -0.25;
      Vec3d at_point{4.0, 4.0, 0.1};
      tip.move(at_point);
      at_point.z = -0.04;
      tip.move(at_point);
      at_point.z = depth;
      tip.move(at_point);
      Vec3d heading{way(random), way(random), 0.0};
      int elements = 0;
      Index last = no_index;
      for (int i = 0; i < 400; ++i) {
        if (i % 20 == 0) {
          heading = {way(random), way(random), 0.0};
        }
        at_point += heading;
        at_point.x = std::clamp(at_point.x, 1.5, 6.5);
        at_point.y = std::clamp(at_point.y, 1.5, 6.5);
        tip.move(at_point);
        ASSERT_FALSE(tip.active.empty()) << seed << " step " << i;
        EXPECT_GT(tip.force().z, 0.0) << seed << " step " << i;
        for (const contact::ActivePair& pair : tip.active) {
          EXPECT_GT(pair.force.z, 0.0) << seed << " step " << i;
        }
        elements += tip.active[0].element != last;
        last = tip.active[0].element;
      }
      EXPECT_GT(elements, 10);
    }
  }
}

TEST(contact_force, of_a_node_that_crosses_the_whole_thickness_in_one_step_pushes_it_back) {
  for (const double thickness : {0.005, 0.1, 0.5}) {
    for (const double sign : {-1.0, 1.0}) {
      Tip tip(flat(4), thickness);
      const double start = thickness + 0.05;
      tip.move({2.3, 1.6, sign * (start + 10.0)});
      tip.move({2.3, 1.6, sign * start});
      EXPECT_TRUE(tip.active.empty());
      tip.move({2.3, 1.6, -sign * 0.05});
      ASSERT_EQ(tip.active.size(), 1U);
      EXPECT_GT(sign * tip.force().z, 0.0);
      EXPECT_NEAR(tip.active[0].depth * thickness, thickness + 0.05, 1e-12);
    }
  }
}

TEST(contact_force, is_that_of_exactly_one_pair_over_smooth_neighbours_their_edges_and_corners) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(1.0, 4.0);
  for (const char* diagonals : {"one", "alternating", "crossed"}) {
    for (const double tilt : {0.0, 0.1}) {
      model::Mesh m = flat(5, diagonals);
      for (Vec3d& x : m.position) {
        x.z = tilt * std::sin(x.x + 0.7 * x.y);
      }
      Tip tip(m, 0.3);
      const auto check = [&](const Vec3d& at_point) {
        tip.memory.clear();
        tip.move(at_point + Vec3d{0.0, 0.0, 2.0});
        tip.move(at_point + Vec3d{0.0, 0.0, 0.35});
        tip.move(at_point + Vec3d{0.0, 0.0, 0.1});
        EXPECT_EQ(tip.active.size(), 1U) << diagonals << " " << at_point.x << " " << at_point.y;
        EXPECT_GT(tip.force().z, 0.0);
      };
      const auto& x = tip.model.reference_position;
      for (Index e = 0; e < tip.model.bodies[0].elements.end; ++e) {
        for (std::size_t a = 0; a < 3; ++a) {
          const Vec3d &one = x[at(tip.model.triangle[at(e)][a])], &two = x[at(tip.model.triangle[at(e)][(a + 1) % 3])];
          if (one.x > 0.5 && one.x < 4.5 && one.y > 0.5 && one.y < 4.5) {
            check(one);
            check(0.5 * (one + two));
            check(0.3 * one + 0.7 * two);
          }
        }
      }
      for (int i = 0; i < 200; ++i) {
        const double right = place(random), up = place(random);
        check({right, up, tilt * std::sin(right + 0.7 * up)});
      }
    }
  }
}

TEST(contact_force, in_a_sharp_valley_is_that_of_both_faces_and_on_a_ridge_of_one_pair) {
  const double angle = 0.9;  // 103 degrees between the normals
  Tip valley(fold(-angle), 0.5);
  valley.move({0.0, 1.7, 1.0});
  valley.move({0.0, 1.7, 0.5});
  ASSERT_EQ(valley.active.size(), 2U);
  EXPECT_NEAR(valley.force().x, 0.0, 1e-12 * norm(valley.force()));
  EXPECT_GT(valley.force().z, 0.0);

  Tip ridge(fold(angle), 0.5);
  ridge.move({0.05, 1.7, 0.6});
  ridge.move({0.05, 1.7, 0.3});
  ASSERT_EQ(ridge.active.size(), 1U);
  EXPECT_NEAR(ridge.force().x / ridge.force().z, 0.05 / 0.3, 1e-9);
}

TEST(contact_force, does_not_hold_a_node_that_has_gone_round_the_rim_of_an_open_surface) {
  for (const double thickness : {0.05, 0.6, 2.5}) {
    Tip tip(flat(6), thickness, 0.5);
    const double above = thickness + 0.02, step = 0.02;
    Vec3d at_point{4.0, 3.1, above + 1.0};
    const auto go_to = [&](const Vec3d& goal) {
      while (norm(goal - at_point) > 1e-12) {
        const Vec3d left = goal - at_point;
        at_point += std::min(1.0, step / norm(left)) * left;
        tip.move(at_point);
        ASSERT_TRUE(tip.active.empty()) << thickness << " at " << at_point.x << " " << at_point.z;
      }
    };
    go_to({4.0, 3.1, above});
    go_to({6.0 + above, 3.1, above});
    go_to({6.0 + above, 3.1, -above});
    go_to({3.0, 3.1, -above});
    for (const model::ContactSide& s : tip.memory) {
      EXPECT_EQ(s.side, -1) << thickness << " element " << s.element;
    }
    tip.move(at_point + Vec3d{0.0, 0.0, 0.04});
    ASSERT_EQ(tip.active.size(), 1U);
    EXPECT_LT(tip.force().z, 0.0);
  }
}

TEST(contact_force, frees_a_node_that_leaves_over_the_rim_while_it_is_behind) {
  Tip tip(flat(6), 0.05, 0.5);
  tip.move({4.5, 3.1, 1.0});
  tip.move({4.5, 3.1, 0.06});
  tip.move({4.5, 3.1, -0.1});
  EXPECT_GT(tip.force().z, 0.0);
  for (double x = 4.5; x < 6.3; x += 0.05) {
    tip.move({x, 3.1, -0.1});
  }
  EXPECT_TRUE(tip.active.empty());
  for (double x = 6.3; x > 4.0; x -= 0.05) {
    tip.move({x, 3.1, -0.1});
    EXPECT_TRUE(tip.active.empty()) << x;
  }
  tip.move({4.0, 3.1, -0.03});
  EXPECT_LT(tip.force().z, 0.0);
}

/// Side of a closed surface by the angle-weighted normal of the feature, which is right for every closed surface
/// [Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal, IEEE TVCG 11 (2005)].
int slow_side(const Tip& tip, Index corner, const Vec3d& offset) {
  const model::Model& model = tip.model;
  Vec3d normal;
  for (Index c = model.corner_start[at(corner)]; c < model.corner_start[at(corner) + 1]; ++c) {
    const Index e = model.corner[at(c)] / 3, a = model.corner[at(c)] % 3;
    const auto& t = model.triangle[at(e)];
    const auto x = [&](Index i) { return model.reference_position[at(t[at(i % 3)])]; };
    const Vec3d one = x(a + 1) - x(a), two = x(a + 2) - x(a);
    const double angle = std::acos(dot(one, two) / (norm(one) * norm(two)));
    normal += (angle / norm(cross(one, two))) * cross(one, two);
  }
  return dot(normal, offset) < 0.0 ? -1 : 1;
}

TEST(contact_side, is_right_at_the_corners_of_spikes_and_dents) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  int seen = 0, disputed = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    model::Mesh ball = model::generate_mesh(model::CubedSphere{1.0, 2});
    for (Vec3d& x : ball.position) {
      x = (1.0 + 0.75 * number(random)) * x;
    }
    const Tip tip(ball, 0.01);
    const contact::Positions x{tip.motion.data(), 0.0};
    contact::Normals normals(tip.model, x);
    for (int i = 0; i < 500; ++i) {
      const Vec3d p{2.0 * number(random), 2.0 * number(random), 2.0 * number(random)};
      Index nearest = no_index;
      double least = HUGE_VAL;
      for (Index e = 0; e < tip.model.bodies[0].elements.end; ++e) {
        const double distance2 = contact::closest_on(tip.model, x, e, p).distance2;
        if (distance2 < least) {
          least = distance2;
          nearest = e;
        }
      }
      const auto closest = contact::closest_on(tip.model, x, nearest, p);
      if (physics::is_corner(closest.feature)) {
        const Index corner = tip.model.triangle[at(nearest)][physics::number_of(closest.feature)];
        const contact::View view = contact::view_of(tip.model, normals, nearest, closest);
        EXPECT_EQ(view.side, slow_side(tip, corner, closest.offset)) << seed << " " << i;
        ++seen;
        disputed += !view.agreed;
      }
    }
  }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(disputed, 100);
}

}  // namespace
}  // namespace fexp
