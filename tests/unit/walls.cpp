// SPDX-License-Identifier: Apache-2.0
#include "solve/walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "solve/diagnostics.hpp"
#include "support/models.hpp"

namespace fexp {
namespace {

using model::Wall;
using model::WallShape;

using test::rubber;

/// A model whose only node has the half thickness 0.5 and the stiffness 10.
model::Model one_node() {
  model::Model model;
  model.half_thickness = {0.5};
  model.contact_stiffness = {10.0};
  model.curves.push_back({"c", {{0.0, 0.0}, {2.0, 1.0}}, {}});
  model.curve_areas = {{0.0, 1.0}};
  return model;
}

Wall wall(WallShape shape, bool inside) {
  Wall w;
  w.shape = shape;
  w.direction = {0.0, 0.0, 1.0};
  w.radius = 2.0;
  w.inside = inside;
  w.stiffness = 4.0;
  return w;
}

struct Push {
  const char* what;
  Wall wall;
  Vec3d position;  ///< From the wall's point
  Vec3d force;
};

TEST(walls, push_nodes_that_are_nearer_than_half_a_thickness_to_their_free_side) {
  const model::Model model = one_node();
  const Vec3d point{7.0, -1.0, 3.0};
  const std::vector<Push> pushes{
      {"plane", wall(WallShape::plane, false), {3.0, 5.0, 0.25}, {0.0, 0.0, 1.0}},
      {"plane, behind", wall(WallShape::plane, false), {0.0, 0.0, -1.0}, {0.0, 0.0, 6.0}},
      {"plane, free", wall(WallShape::plane, false), {0.0, 0.0, 0.5}, {}},
      {"cylinder", wall(WallShape::cylinder, false), {0.0, 2.25, 9.0}, {0.0, 1.0, 0.0}},
      {"cylinder, free", wall(WallShape::cylinder, false), {2.0, 2.0, 9.0}, {}},
      {"in a cylinder", wall(WallShape::cylinder, true), {-1.75, 0.0, 9.0}, {1.0, 0.0, 0.0}},
      {"in a cylinder, free", wall(WallShape::cylinder, true), {0.0, 1.5, 9.0}, {}},
      {"sphere", wall(WallShape::sphere, false), {0.0, 0.0, -2.25}, {0.0, 0.0, -1.0}},
      {"sphere, free", wall(WallShape::sphere, false), {1.5, 1.5, 1.5}, {}},
      {"in a sphere", wall(WallShape::sphere, true), {1.2, 0.0, 1.6}, {-1.2, 0.0, -1.6}},
      {"in a sphere, free", wall(WallShape::sphere, true), {0.0, 0.0, 0.0}, {}},
      {"on the axis", wall(WallShape::cylinder, false), {0.0, 0.0, 1.0}, {}},
  };
  for (const Push& push : pushes) {
    SCOPED_TRACE(push.what);
    const solve::WallReaction r = solve::wall_reaction(model, push.wall, point, 0, point + push.position);
    EXPECT_NEAR(norm(r.force - push.force), 0.0, 1e-14);
    if (push.force != Vec3d{}) {
      EXPECT_EQ(r.stiffness, 4.0);
      EXPECT_NEAR(r.energy, 0.5 * dot(push.force, push.force) / 4.0, 1e-14);
    }
  }
}

TEST(walls, have_the_stiffness_of_the_node_when_none_is_given) {
  Wall w = wall(WallShape::plane, false);
  w.stiffness = -1.0;
  EXPECT_EQ(solve::wall_reaction(one_node(), w, {}, 0, {}).force.z, 5.0);
}

TEST(walls, stand_or_go_where_their_curves_say) {
  const model::Model model = one_node();
  Wall w = wall(WallShape::sphere, false);
  w.point = {1.0, 0.0, 0.0};
  w.motion = {0.0, 3.0, 0.0};
  EXPECT_EQ(solve::wall_point(model, w, 2.0), w.point);
  w.moves = true;
  w.kind = model::PrescribedKind::velocity;
  EXPECT_EQ(solve::wall_point(model, w, 2.0), (Vec3d{1.0, 6.0, 0.0}));
  w.curve = 0;
  EXPECT_EQ(solve::wall_point(model, w, 2.0), (Vec3d{1.0, 3.0, 0.0}));
  EXPECT_EQ(solve::wall_point(model, w, 3.0), (Vec3d{1.0, 6.0, 0.0}));
  w.kind = model::PrescribedKind::displacement;
  EXPECT_EQ(solve::wall_point(model, w, 1.0), (Vec3d{1.0, 1.5, 0.0}));
}

TEST(walls, of_the_deck_come_in_order_and_with_unit_vectors) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 2, 2, "one"});
  d.curves.push_back({"c", {{0.0, 0.0}, {2.0, 1.0}}, {}});
  d.spheres.push_back({{"s", 7.0}, {1.0, 2.0, 3.0}, 5.0, true});
  d.spheres[0].displacement = {0.0, 0.0, 4.0};
  d.spheres[0].curve = "c";
  d.cylinders.push_back({{"c"}, {1.0, 0.0, 0.0}, {0.0, 3.0, 4.0}, 6.0});
  d.cylinders[0].velocity = {2.0, 0.0, 0.0};
  d.planes.push_back({{"p"}, {}, {0.0, 2.0, 0.0}});
  const model::Model model = test::build(d);
  ASSERT_EQ(model.walls.size(), 3U);
  EXPECT_EQ(model.walls[0].name, "p");
  EXPECT_FALSE(model.walls[0].moves);
  EXPECT_NEAR(norm(model.walls[1].direction - Vec3d{0.0, 0.6, 0.8}), 0.0, 1e-15);
  EXPECT_EQ(model.walls[1].radius, 6.0);
  EXPECT_TRUE(model.walls[1].moves);
  EXPECT_EQ(model.walls[1].kind, model::PrescribedKind::velocity);
  EXPECT_EQ(model.walls[1].curve, no_index);
  EXPECT_TRUE(model.walls[2].inside);
  EXPECT_EQ(model.walls[2].stiffness, 7.0);
  EXPECT_EQ(model.walls[2].kind, model::PrescribedKind::displacement);
  EXPECT_EQ(model.walls[2].curve, 0);
}

/// A node of mass 2.5 that is pressed into a plane by 0.5 with the stiffness 10: normal force 5, critical damping 10.
struct Rubbed {
  explicit Rubbed(double friction, double damping) {
    model.mass = {2.5};
    plane = wall(WallShape::plane, false);
    plane.stiffness = -1.0;
    plane.drag = {friction, damping};
    plane.rubbing = 0;
  }
  /// One step of the node; the force on it.
  Vec3d step(const Vec3d& way, double dt, double height = 0.0) {
    reaction = solve::wall_reaction(model, plane, {}, 0, {0.0, 0.0, height});
    dissipated = solve::rub(model, plane, {way, dt}, 0, reaction, drag);
    return reaction.force;
  }

  model::Model model = one_node();
  Wall plane;
  Vec3d drag;
  double dissipated{};
  solve::WallReaction reaction;
};

TEST(rubbing_walls, hold_a_node_like_a_spring_until_coulombs_limit) {
  Rubbed node(0.3, 0.0);
  EXPECT_EQ(node.step({}, 0.1), (Vec3d{0.0, 0.0, 5.0}));
  EXPECT_EQ(node.dissipated, 0.0);
  EXPECT_NEAR(norm(node.step({0.06, -0.08, 0.0}, 0.1) - Vec3d{-0.6, 0.8, 5.0}), 0.0, 1e-15);
  EXPECT_NEAR(node.dissipated, 0.0, 1e-16);
  EXPECT_NEAR(node.reaction.energy, 0.5 * 10.0 * 0.25 + 0.5 * 10.0 * 0.01, 1e-15);
  EXPECT_EQ(node.reaction.stiffness, 10.0);
  // Farther than 1.5/10 it slips; what is not stored is dissipated.
  EXPECT_NEAR(norm(node.step({0.12, -0.16, 0.0}, 0.1) - Vec3d{-0.9, 1.2, 5.0}), 0.0, 1e-15);
  EXPECT_NEAR(node.dissipated, 0.5 * (1.0 + 1.5) * 0.2 + 0.05 - 0.5 * 1.5 * 1.5 / 10.0, 1e-15);
  EXPECT_GT(node.dissipated, 0.0);
}

TEST(rubbing_walls, damp_the_normal_motion_and_do_not_pull) {
  Rubbed node(0.0, 0.2);
  EXPECT_NEAR(node.step({0.0, 0.0, -0.1}, 0.1).z, 5.0 + 2.0, 1e-14);
  EXPECT_NEAR(node.reaction.stiffness, 10.0 * node.plane.drag.frequency2_factor(), 1e-14);
  EXPECT_GT(node.reaction.stiffness, 10.0);
  EXPECT_EQ(node.step({0.0, 0.0, 1.0}, 0.1).z, 0.0);
}

TEST(rubbing_walls, act_as_before_where_no_step_is_taken) {
  Rubbed node(0.3, 0.2);
  const Vec3d force = node.step({0.01, 0.0, -0.01}, 0.1);
  const double energy = node.reaction.energy;
  const Vec3d drag = node.drag;
  EXPECT_EQ(node.step({}, 0.0), force);
  EXPECT_EQ(node.reaction.energy, energy);
  EXPECT_EQ(node.drag, drag);
  EXPECT_EQ(node.dissipated, 0.0);
}

TEST(rubbing_walls, lose_what_was_stored_in_a_node_that_leaves) {
  Rubbed node(0.3, 0.0);
  node.step({0.1, 0.0, 0.0}, 0.1);
  EXPECT_EQ(node.step({0.02, 0.0, 1.0}, 0.1, 1.0), Vec3d{});
  EXPECT_EQ(node.drag, Vec3d{});
  EXPECT_NEAR(node.dissipated, 0.05 - 0.5 * -1.0 * 0.02, 1e-15);
  node.step({}, 0.1, 1.0);
  EXPECT_EQ(node.dissipated, 0.0);
}

TEST(rubbing_walls, take_friction_and_damping_of_contact_where_they_have_none_of_their_own) {
  auto d = test::description(rubber, 0.02);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 2, 2, "one"});
  d.contact.friction = 0.3;
  d.contact.damping = 0.1;
  d.planes.push_back({{"a"}, {}, {0.0, 0.0, 1.0}});
  d.planes.push_back({{"smooth", -1.0, 0.0, 0.0}, {}, {0.0, 0.0, 1.0}});
  d.spheres.push_back({{"b", -1.0, 0.5}, {}, 1.0});
  d.cylinders.push_back({{"c", -1.0, {}, 0.7}, {}, {1.0, 0.0, 0.0}, 1.0});
  model::Model model = test::build(d);
  ASSERT_EQ(model.walls.size(), 4U);
  EXPECT_EQ(model.rubbing_walls, 3);
  const auto is = [&](std::size_t i, double friction, double damping, Index rubbing) {
    const Wall& w = model.walls[i];
    EXPECT_EQ(w.drag.friction, friction) << w.name;
    EXPECT_EQ(w.drag.damping, damping) << w.name;
    EXPECT_EQ(w.rubbing, rubbing) << w.name;
  };
  is(0, 0.3, 0.1, 0);
  is(1, 0.0, 0.0, no_index);
  is(2, 0.3, 0.7, 1);
  is(3, 0.5, 0.1, 2);
  EXPECT_EQ(model::initial_state(model).wall_drag.size(), 3U * 9U);
  d.contact.friction = d.contact.damping = 0.0;
  d.spheres[0].friction.reset();
  d.cylinders[0].damping.reset();
  model = test::build(d);
  EXPECT_EQ(model.rubbing_walls, 0);
  EXPECT_TRUE(model::initial_state(model).wall_drag.empty());
}

/// A ball that rolls in a bowl with friction and damping: the energies stay in balance while it slips, turns and rests.
TEST(rubbing_walls, keep_the_balance_of_energy_where_they_are_curved) {
  for (const bool rigid : {false, true}) {
    auto d = test::description({1000.0, 1.0e6, 0.3}, 0.01);
    model::BodyDescription& ball = test::add_body(d, "ball", model::CubedSphere{0.1, 4});
    ball.rigid = rigid;
    ball.translate = {0.5, 0.0, -0.74};
    ball.angular_velocity = {0.0, 20.0, 0.0};
    d.spheres.push_back({{"bowl", 2.0e4, 0.3, 0.1}, {}, 1.0, true});
    d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
    const model::Model model = test::build(d);
    test::DirectRun run(model);
    const double start = solve::diagnostics(model, run.state).energies.balance();
    double open = 0.0;
    const double dt = 0.1 * model.first_critical_step;
    const auto steps = static_cast<int>(1.0 / dt);
    for (int i = 0; i < steps / 10; ++i) {
      run.advance(dt, 10);
      open = std::max(open, std::abs(solve::diagnostics(model, run.state).energies.balance() - start));
    }
    const solve::Energies e = solve::diagnostics(model, run.state).energies;
    EXPECT_GT(e.friction, 0.1) << rigid;
    EXPECT_LT(open, 0.01 * (e.kinetic + e.friction)) << rigid;
  }
}

}  // namespace
}  // namespace fexp
