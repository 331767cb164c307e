// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>

#include "contact/edge_watch.hpp"
#include "contact/whole_search.hpp"
#include "support/contact.hpp"

/// Edges against edges.
namespace fexp {
namespace {

/// Two roofs of two triangles each, whose ridges cross at a distance `gap`: the lower one's runs along x, the upper
/// one's along y. A slope of 0 makes them plates.
class Roofs {
 public:
  explicit Roofs(double gap, double slope = 0.5, double thickness = 0.1, double friction = 0.0) {
    auto d = test::description(test::rubber, thickness);
    d.contact.enabled = true;
    d.contact.stiffness = 1.0e5;
    d.contact.friction = friction;
    test::add_body(d, "lower", model::CubedSphere{});
    test::add_body(d, "upper", model::CubedSphere{});
    const model::Mesh lower =
        test::mesh({{-1, 0, 0}, {1, 0, 0}, {0, 1, -slope}, {0, -1, -slope}}, {{0, 1, 2}, {1, 0, 3}});
    const model::Mesh upper =
        test::mesh({{0.1, -1, gap}, {0.2, 1, gap}, {1, 0, gap + slope}, {-1, 0, gap + slope}}, {{0, 2, 1}, {1, 3, 0}});
    model = test::build(d, {lower, upper});
    state = model::initial_state(model);
    contact.emplace(model, state);
  }

  /// Moves the upper roof in one step, and looks.
  contact::ContactReport move(const Vec3d& way) {
    for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
      state.motion[at(n)].velocity = way;
      state.motion[at(n)].position += way;
    }
    contact->island.advance(model, state, norm(way));
    return contact->evaluate(model, state, 1.0);
  }

  [[nodiscard]] Vec3d force_on(Index body) const {
    Vec3d sum;
    for (Index n = model.bodies[at(body)].nodes.begin; n < model.bodies[at(body)].nodes.end; ++n) {
      sum += contact->nodes.force[at(n)];
    }
    return sum;
  }

  model::Model model;
  model::State state;
  std::optional<test::Contact> contact;
};

TEST(edges, that_cross_push_each_other_apart_along_their_common_normal) {
  Roofs roofs(0.2);
  EXPECT_EQ(roofs.move({}).active_pairs, 0);
  EXPECT_EQ(roofs.move({0.0, 0.0, -0.13}).active_pairs, 1);
  EXPECT_NEAR(roofs.force_on(1).z, 1.0e5 * 0.03, 1e-6);
  EXPECT_NEAR(roofs.force_on(1).x, 0.0, 1e-9);
  EXPECT_NEAR(norm(roofs.force_on(0) + roofs.force_on(1)), 0.0, 1e-9);
  EXPECT_NEAR(roofs.contact->energy(), 0.5 * 1.0e5 * 0.03 * 0.03, 1e-9);
}

TEST(edges, that_have_come_through_each_other_are_pushed_back) {
  Roofs roofs(0.2);
  roofs.move({0.0, 0.0, -0.05});
  roofs.move({0.0, 0.0, -0.1});
  const double before = roofs.force_on(1).z;
  roofs.move({0.0, 0.0, -0.07});
  EXPECT_GT(roofs.force_on(1).z, 0.9 * before);
  roofs.move({0.0, 0.0, -0.05});
  EXPECT_GT(roofs.force_on(1).z, 0.0);
}

TEST(edges, that_cross_within_one_step_belong_where_they_were) {
  Roofs roofs(0.2);
  roofs.move({});
  roofs.move({0.0, 0.0, -0.25});
  EXPECT_GT(roofs.force_on(1).z, 0.0);
}

TEST(edges, that_start_on_the_other_side_are_pushed_there) {
  Roofs roofs(-0.2, -0.5);
  roofs.move({});
  EXPECT_EQ(roofs.move({0.0, 0.0, 0.15}).active_pairs, 1);
  EXPECT_LT(roofs.force_on(1).z, 0.0);
}

TEST(edges, do_nothing_where_the_deck_says_so) {
  Roofs roofs(0.2);
  roofs.model.contact.edges = false;
  roofs.contact.emplace(roofs.model, roofs.state);
  roofs.move({});
  EXPECT_EQ(roofs.move({0.0, 0.0, -0.13}).active_pairs, 0);
}

TEST(edges, of_flat_folds_leave_it_to_nodes_and_faces) {
  Roofs roofs(0.2, 0.0);
  roofs.move({});
  roofs.move({0.0, 0.0, -0.13});
  Index ridges[2] = {no_index, no_index};
  for (Index edge = 0; edge < 3 * roofs.model.element_count(); ++edge) {
    if (roofs.model.neighbour[at(edge / 3)][static_cast<std::size_t>(edge % 3)] > edge / 3) {
      ridges[edge / 3 < 2 ? 0 : 1] = edge;
    }
  }
  const contact::Positions x{roofs.state.motion.data(), 0.0};
  std::vector<model::EdgeSide> remembered;
  std::vector<contact::ActiveEdges> active;
  double due = 0.0;
  contact::EdgeWatch(roofs.model, x, x).look(ridges[0], {{&ridges[1], 1}, {&due, 1}, 0.0}, {}, remembered, active);
  EXPECT_EQ(remembered.size(), 1U);
  EXPECT_TRUE(active.empty());
}

TEST(edges, push_no_more_than_the_shell_was_thick_where_the_mesh_has_them_nearer) {
  Roofs roofs(0.04);
  EXPECT_EQ(roofs.move({}).active_pairs, 0);
  roofs.move({0.0, 0.0, -0.01});
  EXPECT_NEAR(roofs.force_on(1).z, 1.0e5 * 0.01, 1e-6);
}

TEST(edges, stay_on_their_side_in_the_bytes_of_the_state) {
  Roofs roofs(0.2);
  roofs.move({0.0, 0.0, -0.12});
  roofs.move({0.0, 0.0, -0.1});  // Through
  roofs.contact->island.store_sides(roofs.model, roofs.state);
  const Vec3d force = roofs.force_on(1);
  model::State other = model::initial_state(roofs.model);
  for (Index body = 0; body < 2; ++body) {
    std::vector<std::byte> bytes;
    model::append_body_bytes(roofs.model, roofs.state, body, bytes);
    ASSERT_TRUE(model::read_body_bytes(roofs.model, bytes, body, other));
  }
  ASSERT_EQ(other.edge_sides[0].size(), 1U);
  test::Contact again(roofs.model, other);
  again.evaluate(roofs.model, other, 0.0);
  Vec3d sum;
  for (Index n = roofs.model.bodies[1].nodes.begin; n < roofs.model.bodies[1].nodes.end; ++n) {
    sum += again.nodes.force[at(n)];
  }
  EXPECT_EQ(sum, force);
}

TEST(edges, rub_with_coulombs_coefficient) {
  Roofs roofs(0.2, 0.5, 0.1, 0.25);
  roofs.move({});
  roofs.move({0.0, 0.0, -0.13});
  for (int i = 0; i < 5; ++i) {
    roofs.move({0.02, 0.0, 0.0});
  }
  EXPECT_NEAR(roofs.force_on(1).x, -0.25 * 1.0e5 * 0.03, 1e-6);
  EXPECT_NEAR(norm(roofs.force_on(0) + roofs.force_on(1)), 0.0, 1e-9);
}

/// Two meshes of random roofs that overlap, with one stiffness and one thickness, as the forces are derivatives but
/// for those of stiffness and thickness.
model::Model rough_plates(unsigned seed) {
  auto d = test::description(test::rubber, 0.3);
  d.contact.enabled = true;
  d.contact.self = false;
  d.contact.stiffness = 1.0e5;
  test::add_body(d, "lower", model::CubedSphere{});
  test::add_body(d, "upper", model::CubedSphere{});
  model::Mesh lower = model::generate_mesh(test::plate(4.0, 4.0, 4, 4));
  model::Mesh upper = model::generate_mesh(test::plate(4.0, 4.0, 3, 3));
  test::shake(lower, 0.3, seed);
  test::shake(upper, 0.3, seed + 1000);
  for (Vec3d& x : upper.position) {
    x += Vec3d{0.3, 0.2, 0.9};
  }
  return test::build(d, {lower, upper});
}

TEST(edges, give_forces_that_are_the_gradient_of_the_energy_and_sum_to_no_moment) {
  int with_edges = 0, compared = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const model::Model model = rough_plates(seed);
    model::State state = model::initial_state(model);
    for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
      state.motion[at(n)].position.z -= 0.35;
    }
    const auto look = [&] {
      test::Contact contact(model, state);
      const auto report = contact.evaluate(model, state, 0.0);
      return std::pair{contact, report.active_pairs};
    };
    const auto first_look = look();
    const test::Contact& base = first_look.first;
    const Index pairs = first_look.second;
    Vec3d force, moment;
    double scale = 0.0;
    for (Index n = 0; n < model.node_count(); ++n) {
      force += base.nodes.force[at(n)];
      moment += cross(state.motion[at(n)].position, base.nodes.force[at(n)]);
      scale += norm(base.nodes.force[at(n)]);
    }
    EXPECT_LE(norm(force), 1e-12 * scale);
    EXPECT_LE(norm(moment), 1e-11 * scale);
    base.island.store_sides(model, state);
    with_edges += state.edge_sides[0].empty() ? 0 : 1;
    state.sides[0].clear();
    state.sides[1].clear();
    state.edge_sides[0].clear();
    state.edge_sides[1].clear();
    constexpr double step = 1e-6;
    for (Index n = 0; n < model.node_count(); ++n) {
      for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        const double kept = state.motion[at(n)].position.*axis;
        const auto energy_at = [&](double x) {
          state.motion[at(n)].position.*axis = x;
          const auto [contact, count] = look();
          return count == pairs ? contact.energy() : NAN;
        };
        const double slope = (energy_at(kept + step) - energy_at(kept - step)) / (2.0 * step);
        state.motion[at(n)].position.*axis = kept;
        if (std::isfinite(slope)) {
          EXPECT_NEAR(-slope, base.nodes.force[at(n)].*axis, 2e-3 * scale / pairs) << "node " << n << " seed " << seed;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(with_edges, 8);
  EXPECT_GT(compared, 1000);
}

TEST(edge_search, finds_all_pairs_and_no_others_whatever_their_blocks_are) {
  const model::Model model = rough_plates(5);
  model::State state = model::initial_state(model);
  for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
    state.motion[at(n)].position.z -= 0.4;
  }
  const contact::Positions x{state.motion.data(), 0.0};
  contact::WholeSearch search;
  const std::vector<Index> bodies{0, 1};
  search.assign(model, bodies);
  contact::CandidateRows found;
  constexpr double skin = 0.2;
  const std::vector<Index> remembered{1, 1, 40};
  search.find_partners(model, x, skin);
  search.find_edges(x, skin, remembered, found);
  std::set<std::pair<Index, Index>> pairs, expected;
  for (std::size_t row = 0; row < found.owner.size(); ++row) {
    for (Index c = found.start[row]; c < found.start[row + 1]; ++c) {
      pairs.insert({found.owner[row], found.partner[at(c)]});
    }
  }
  EXPECT_TRUE(std::is_sorted(found.owner.begin(), found.owner.end()));
  for (const Index row : remembered) {
    EXPECT_TRUE(std::binary_search(found.owner.begin(), found.owner.end(), row));
  }
  for (Index a = 0; a < 3 * model.element_count(); ++a) {
    for (Index b = a + 1; b < 3 * model.element_count(); ++b) {
      const auto is_owner = [&](Index edge) {
        const Index other = model.neighbour[at(edge / 3)][static_cast<std::size_t>(edge % 3)];
        return other == no_index || edge / 3 < other;
      };
      const auto p = contact::ends_of(model, a), q = contact::ends_of(model, b);
      const bool met = p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
      const Index body_a = contact::body_of_element(model, a / 3), body_b = contact::body_of_element(model, b / 3);
      if (!is_owner(a) || !is_owner(b) || met || !model.can_touch(body_a, body_b)) {
        continue;
      }
      const double distance = std::sqrt(physics::edge_distance2(x(p[0]), x(p[1]), x(q[0]), x(q[1])));
      if (distance <= skin + contact::edge_reach(model, a) + contact::edge_reach(model, b)) {
        expected.insert({a, b});
      }
    }
  }
  EXPECT_EQ(pairs, expected);
  EXPECT_GT(expected.size(), 50U);
}

}  // namespace
}  // namespace fexp
