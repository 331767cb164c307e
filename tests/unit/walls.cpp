// SPDX-License-Identifier: Apache-2.0
#include "solve/walls.hpp"

#include <gtest/gtest.h>

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
  d.spheres.push_back({"s", {1.0, 2.0, 3.0}, 5.0, true, 7.0, {}, {}, {0.0, 0.0, 4.0}, "c"});
  d.cylinders.push_back({"c", {1.0, 0.0, 0.0}, {0.0, 3.0, 4.0}, 6.0, false, -1.0, {}, {2.0, 0.0, 0.0}, {}, ""});
  d.planes.push_back({"p", {}, {0.0, 2.0, 0.0}, -1.0, {}, {}, {}, ""});
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

}  // namespace
}  // namespace fexp
