// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "contact/whole_search.hpp"
#include "model/state.hpp"
#include "support/contact.hpp"

namespace fexp::contact {
namespace {

using Pair = std::pair<Index, Index>;

/// Three bodies of different mesh size and thickness, close together.
model::Model bodies_of_all_sizes(bool self, bool exclude) {
  auto d = test::description(test::rubber, 0.05);
  d.sections.push_back({"thick", "m", 0.4, {}});
  d.contact.enabled = true;
  d.contact.self = self;
  test::add_body(d, "coarse", test::plate(3.0, 3.0, 3, 3)).translate = {-1.5, -1.5, 0.0};
  test::add_body(d, "fine", model::CubedSphere{0.5, 4}).translate = {0.0, 0.0, 0.8};
  test::add_body(d, "thick", model::Cylinder{0.4, 1.0, 8, 5, 360.0}).translate = {0.9, 0.0, 0.1};
  d.bodies.back().section = "thick";
  if (exclude) {
    d.contact.exclude.push_back({"coarse", "thick"});
  }
  return test::build(d);
}

/// All pairs that may touch within `reach` beyond watch distance, by a loop over all.
std::set<Pair> slow_pairs(const model::Model& model, const Positions& x, double reach) {
  std::set<Pair> pairs;
  for (Index n = 0; n < model.node_count(); ++n) {
    for (Index e = 0; e < model.element_count(); ++e) {
      if (may_touch(model, n, e) &&
          std::sqrt(closest_on(model, x, e, x(n)).distance2) < watch_distance(model, n, e) + reach) {
        pairs.emplace(n, e);
      }
    }
  }
  return pairs;
}

std::set<Pair> pairs_of(const CandidateRows& c) {
  std::set<Pair> pairs;
  for (std::size_t row = 0; row < c.owner.size(); ++row) {
    for (Index i = c.start[row]; i < c.start[row + 1]; ++i) {
      pairs.emplace(c.owner[row], c.partner[at(i)]);
    }
  }
  EXPECT_EQ(pairs.size(), c.partner.size()) << "a pair comes twice";
  return pairs;
}

/// All pairs of edges that cross each other within watch distance, by a loop over all.
std::set<Pair> slow_edge_pairs(const model::Model& model, const Positions& x) {
  std::vector<Index> edges;
  for (Index edge = 0; edge < 3 * model.element_count(); ++edge) {
    const Index other = model.neighbour[at(edge / 3)][at(edge % 3)];
    if (other == no_index || edge / 3 < other) {
      edges.push_back(edge);
    }
  }
  constexpr double least = physics::feature_tolerance, most = 1.0 - physics::feature_tolerance;
  std::set<Pair> pairs;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const auto a = ends_of(model, edges[i]), b = ends_of(model, edges[j]);
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1] ||
          !model.can_touch(model.node_body[at(a[0])], model.node_body[at(b[0])])) {
        continue;
      }
      const auto c = physics::closest_on_lines(x(a[0]), x(a[1]), x(b[0]), x(b[1]));
      if (c.sine2 > physics::parallel_sine2 && c.first > least && c.first < most && c.second > least &&
          c.second < most && std::abs(c.gap) < edge_reach(model, edges[i]) + edge_reach(model, edges[j])) {
        pairs.emplace(edges[i], edges[j]);
      }
    }
  }
  return pairs;
}

std::vector<Index> all_bodies(const model::Model& model) {
  std::vector<Index> bodies;
  for (Index b = 0; b < model.body_count(); ++b) {
    bodies.push_back(b);
  }
  return bodies;
}

TEST(candidates, are_those_of_a_loop_over_all_pairs) {
  for (const bool self : {false, true}) {
    for (const bool exclude : {false, true}) {
      const model::Model model = bodies_of_all_sizes(self, exclude);
      WholeSearch search;
      search.assign(model, all_bodies(model));
      model::State state = model::initial_state(model);
      std::mt19937 random(1);
      std::uniform_real_distribution<double> shift(-0.1, 0.1);
      for (const double skin : {0.0, 0.05, 0.3}) {
        for (model::NodeMotion& m : state.motion) {
          m.position += Vec3d{shift(random), shift(random), shift(random)};
        }
        const Positions x{state.motion.data(), 0.0};
        CandidateRows found;
        search.find_partners(model, x, skin);
        search.find_nodes(model, x, skin, {}, found);
        EXPECT_EQ(pairs_of(found), slow_pairs(model, x, skin));
        EXPECT_GT(found.partner.size(), 100U);
      }
    }
  }
}

/// A barrier that is far larger than what is near it: in the middle, across its rim, and out of reach.
TEST(candidates, of_a_barrier_are_those_of_a_loop_over_all_pairs) {
  auto d = test::description(test::rubber, 0.05);
  d.contact.enabled = true;
  test::add_body(d, "floor", test::plate(8.0, 8.0, 24, 24)).translate = {-4.0, -4.0, 0.0};
  test::add_body(d, "wall", test::plate(8.0, 3.0, 16, 6)).translate = {-4.0, -4.0, 0.02};
  test::add_body(d, "ball", model::CubedSphere{0.5, 4}).translate = {0.0, 0.0, 0.55};
  model::Model model = test::build(d);
  model.bodies[0].barrier = true;
  model.bodies[1].barrier = true;
  WholeSearch search;
  search.assign(model, all_bodies(model));
  const model::State built = model::initial_state(model);
  for (const Vec3d& shift : {Vec3d{}, Vec3d{4.3, 0.0, -0.4}, Vec3d{0.0, -4.0, 0.0}, Vec3d{0.0, 0.0, 9.0}}) {
    model::State state = built;
    for (Index n = model.bodies[2].nodes.begin; n < model.bodies[2].nodes.end; ++n) {
      state.motion[at(n)].position += shift;
    }
    const Positions x{state.motion.data(), 0.0};
    for (const double skin : {0.0, 0.1, 1.0}) {
      CandidateRows found;
      search.find_partners(model, x, skin);
      search.find_nodes(model, x, skin, {}, found);
      EXPECT_EQ(pairs_of(found), slow_pairs(model, x, skin)) << shift.x << ", " << shift.y << ", " << skin;
    }
  }
}

TEST(candidates, ascend_and_give_remembered_nodes_a_row_and_each_row_the_slack_of_its_nearest_pair) {
  const model::Model model = bodies_of_all_sizes(true, false);
  WholeSearch search;
  search.assign(model, all_bodies(model));
  const model::State state = model::initial_state(model);
  const Positions x{state.motion.data(), 0.0};
  CandidateRows found;
  const std::vector<Index> remembered{0, 0, 3, 17, model.node_count() - 1};
  search.find_partners(model, x, 0.05);
  search.find_nodes(model, x, 0.05, remembered, found);
  EXPECT_TRUE(std::is_sorted(found.owner.begin(), found.owner.end()));
  for (const Index node : remembered) {
    EXPECT_TRUE(std::binary_search(found.owner.begin(), found.owner.end(), node));
  }
  for (std::size_t row = 0; row < found.owner.size(); ++row) {
    double least = HUGE_VAL;
    for (Index i = found.start[row]; i < found.start[row + 1]; ++i) {
      const Index e = found.partner[at(i)], n = found.owner[row];
      EXPECT_TRUE(i == found.start[row] || found.partner[at(i - 1)] < e);
      least = std::min(least, std::sqrt(closest_on(model, x, e, x(n)).distance2) - watch_distance(model, n, e));
    }
    EXPECT_LE(found.slack[row], least);
    EXPECT_TRUE(least == HUGE_VAL || found.slack[row] > least - 1e-6);
  }
}

/// Bodies that fly, turn and breathe at random; all positions are a smooth function of time.
class Dance {
 public:
  Dance(const model::Model& model, unsigned seed, double speed) : model_(model), random_(seed) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const auto vector = [&] { return Vec3d{number(random_), number(random_), number(random_)}; };
    for (Index b = 0; b < model.body_count(); ++b) {
      velocity_.push_back(speed * vector());
      spin_.push_back((3.0 * speed) * vector());
      wave_.push_back(3.0 * vector());
      amplitude_.push_back((0.3 * speed) * vector());
    }
    common_ = (10.0 * speed) * vector();
  }

  /// Positions after a step of `dt`, and the largest way that any node has gone.
  double step(model::State& state, double time, double dt) {
    double largest = 0.0;
    for (Index n = 0; n < model_.node_count(); ++n) {
      const auto b = at(model_.node_body[at(n)]);
      const Vec3d r = model_.reference_position[at(n)] - Vec3d{0.0, 0.0, 0.5};
      const Vec3d v = common_ + std::cos(time) * velocity_[b] + cross(spin_[b], r) +
                      std::cos(dot(wave_[b], r) + 4.0 * time) * amplitude_[b];
      model::NodeMotion& m = state.motion[at(n)];
      m.velocity = v;
      m.position += dt * v;
      largest = std::max(largest, norm(v));
    }
    return largest * dt;
  }

 private:
  const model::Model& model_;
  std::mt19937 random_;
  std::vector<Vec3d> velocity_, spin_, wave_, amplitude_;
  Vec3d common_;
};

/// Number of pairs of nodes with elements and of edges that an island remembers, which are all that are near.
std::pair<std::size_t, std::size_t> all_near_are_remembered(const model::Model& model, const test::Contact& contact,
                                                            model::State& state) {
  contact.island.store_sides(model, state);
  std::set<Pair> nodes, edges;
  for (const auto& sides : state.sides) {
    for (const model::ContactSide& s : sides) {
      nodes.emplace(s.node, s.element);
    }
  }
  for (const auto& sides : state.edge_sides) {
    for (const model::EdgeSide& s : sides) {
      edges.emplace(s.first, s.second);
    }
  }
  const Positions x{state.motion.data(), 0.0};
  std::size_t near = 0;
  for (const Pair& pair : slow_pairs(model, x, 0.0)) {
    EXPECT_TRUE(nodes.count(pair)) << "node " << pair.first << " element " << pair.second;
    ++near;
  }
  EXPECT_EQ(edges, slow_edge_pairs(model, x));
  return {near, edges.size()};
}

TEST(candidates, no_pair_within_watch_distance_is_missed_over_random_motions) {
  const model::Model model = bodies_of_all_sizes(true, false);
  Index searches = 0;
  std::size_t watched = 0, watched_edges = 0;
  constexpr int steps = 120;
  for (unsigned seed = 0; seed < 6; ++seed) {
    Dance dance(model, seed, std::pow(10.0, -1.0 - 0.25 * seed));
    model::State state = model::initial_state(model);
    test::Contact contact(model, state);
    contact.evaluate(model, state, 0.0);
    ContactReport report;
    for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " step " << i);
      const double dt = 0.02, way = dance.step(state, i * dt, dt);
      contact.island.advance(model, state, way);
      report = contact.evaluate(model, state, dt);
      const auto [nodes, edges] = all_near_are_remembered(model, contact, state);
      watched += nodes;
      watched_edges += edges;
    }
    searches += report.searches;
  }
  // The claim is about steps without a search.
  EXPECT_LT(searches, 6 * steps / 2);
  EXPECT_GT(watched, 1000U);
  EXPECT_GT(watched_edges, 1000U);
}

/// The bound of what nodes may have travelled is then what they have.
TEST(candidates, no_pair_is_missed_of_bodies_that_go_straight_at_each_other) {
  const model::Model model = bodies_of_all_sizes(false, false);
  constexpr int steps = 150;
  Index searches = 0;
  std::size_t watched = 0, watched_edges = 0;
  for (const Vec3d& shift : {Vec3d{0.0, 0.0, 0.4}, Vec3d{0.03, 0.02, 0.37}, Vec3d{0.2, -0.1, 0.34}}) {
    model::State state = model::initial_state(model);
    const auto move = [&](double part) {
      for (Index n = 0; n < model.node_count(); ++n) {
        const Index body = model.node_body[at(n)];
        const Vec3d way = (body == 1 ? part : body == 0 ? -part : 0.0) * shift;
        state.motion[at(n)].position += way;
      }
    };
    move(0.5);
    test::Contact contact(model, state);
    contact.evaluate(model, state, 0.0);
    ContactReport report;
    for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(::testing::Message() << "shift " << shift.x << " step " << i);
      move(-1.0 / steps);
      contact.island.advance(model, state, norm(shift) / steps);
      report = contact.evaluate(model, state, 0.01);
      const auto [nodes, edges] = all_near_are_remembered(model, contact, state);
      watched += nodes;
      watched_edges += edges;
    }
    searches += report.searches;
  }
  EXPECT_LT(searches, 3 * steps / 4);
  EXPECT_GT(watched, 1000U);
  EXPECT_GT(watched_edges, 100U);
}

}  // namespace
}  // namespace fexp::contact
