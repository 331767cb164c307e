// SPDX-License-Identifier: Apache-2.0
#include "contact/block_wear.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "model/state.hpp"
#include "support/contact.hpp"

namespace fexp::contact {
namespace {

constexpr double skin = 0.05, margin = 0.1;

/// Two plates over each other, of several blocks each.
model::Model two_plates() {
  auto d = test::description(test::rubber, 0.01);
  d.contact.enabled = true;
  test::add_body(d, "lower", test::plate(1.0, 1.0, 8, 8));
  test::add_body(d, "upper", test::plate(1.0, 1.0, 8, 8)).translate = {0.0, 0.0, 0.06};
  return test::build(d);
}

struct Scene {
  model::Model model = two_plates();
  model::State state = model::initial_state(model);
  BlockPairs pairs;
  BlockWear wear;

  Scene() {
    pairs.assign(model, std::vector<Index>{0, 1});
    pairs.search(model, positions(), skin + margin);
    wear.begin(pairs, positions());
  }
  [[nodiscard]] Positions positions() const { return {state.motion.data(), 0.0}; }
  void move_upper(const Vec3d& way) {
    for (Index n = model.bodies[1].nodes.begin; n < model.bodies[1].nodes.end; ++n) {
      state.motion[at(n)].position += way;
    }
  }
  [[nodiscard]] Index body_of(Index block) const { return model.blocks[at(pairs.blocks()[at(block)])].body; }
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    for (Index block = 0; block < pairs.count(); ++block) {
      const IndexRange partners = pairs.partners_of(block);
      for (Index p = partners.begin; p < partners.end; ++p) {
        visit(block, p, pairs.partners()[at(p)]);
      }
    }
  }
};

TEST(block_wear, is_at_least_what_nodes_of_the_two_have_moved_against_each_other) {
  Scene scene;
  const model::State start = scene.state;
  EXPECT_EQ(scene.wear.take_due(scene.pairs, skin).size(), at(scene.pairs.count()));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> way(-0.002, 0.002);
  for (int i = 0; i < 5; ++i) {
    for (model::NodeMotion& m : scene.state.motion) {
      m.position += Vec3d{way(random) + 0.1, way(random), way(random)};
    }
    scene.wear.add(scene.pairs, scene.positions(), 0.0);
  }
  double largest = 0.0;
  scene.for_each_pair([&](Index block, Index p, Index partner) {
    const IndexRange a = scene.pairs.nodes_of(block), b = scene.pairs.nodes_of(partner);
    for (Index k = a.begin; k < a.end; ++k) {
      for (Index l = b.begin; l < b.end; ++l) {
        const Index m = scene.pairs.nodes()[at(k)], n = scene.pairs.nodes()[at(l)];
        const auto moved = [&](Index node) {
          return scene.state.motion[at(node)].position - start.motion[at(node)].position;
        };
        const double motion = norm(moved(m) - moved(n));
        ASSERT_LE(motion, scene.wear.used(p));
        largest = std::max(largest, motion);
      }
    }
  });
  EXPECT_GT(largest, 0.0);
  // Common flight of half a length is no wear.
  EXPECT_LT(scene.wear.most_used(), 0.05);
  EXPECT_LT(scene.wear.whole(), 0.05);
}

TEST(block_wear, makes_those_due_that_have_moved_against_each_other_and_no_others) {
  Scene scene;
  EXPECT_EQ(scene.wear.take_due(scene.pairs, skin).size(), at(scene.pairs.count()));
  scene.move_upper({0.6 * skin, 0.0, 0.0});
  scene.wear.add(scene.pairs, scene.positions(), 0.0);
  EXPECT_NEAR(scene.wear.last(), 0.6 * skin, 1e-12);
  EXPECT_FALSE(scene.wear.take_due(scene.pairs, skin).empty());
  std::size_t due = 0, others = 0;
  scene.for_each_pair([&](Index block, Index p, Index partner) {
    const bool apart = scene.body_of(block) != scene.body_of(partner);
    EXPECT_EQ(scene.wear.is_due(p), apart);
    EXPECT_NEAR(scene.wear.used(p), 0.0, 1e-12);
    (apart ? due : others) += 1;
  });
  EXPECT_GT(due, 0U);
  EXPECT_GT(others, 0U);
  // Less than half the skin: none.
  scene.move_upper({0.3 * skin, 0.0, 0.0});
  scene.wear.add(scene.pairs, scene.positions(), 0.0);
  EXPECT_TRUE(scene.wear.take_due(scene.pairs, skin).empty());
  scene.for_each_pair([&](Index, Index p, Index) { EXPECT_FALSE(scene.wear.is_due(p)); });
}

TEST(block_wear, of_partners_that_stay_is_kept_when_partners_change_and_new_ones_are_due) {
  Scene scene;
  (void)scene.wear.take_due(scene.pairs, skin);
  scene.move_upper({0.3 * skin, 0.0, 0.0});
  scene.wear.add(scene.pairs, scene.positions(), 0.0);
  (void)scene.wear.take_due(scene.pairs, skin);
  const auto before = scene.pairs.partners().size();
  // Some rows on: what was above each other is not, and other blocks are.
  scene.move_upper({0.0, 0.5, 0.0});
  scene.pairs.search(scene.model, scene.positions(), skin + margin);
  scene.wear.take_over(scene.pairs);
  EXPECT_NE(scene.pairs.partners().size(), before);
  std::size_t kept = 0, made = 0;
  scene.for_each_pair([&](Index block, Index p, Index partner) {
    const bool old = scene.pairs.before()[at(p)] != no_index;
    EXPECT_EQ(scene.wear.is_due(p), !old);
    if (old) {
      ++kept;
      EXPECT_NEAR(scene.wear.used(p), scene.body_of(block) == scene.body_of(partner) ? 0.0 : 0.3 * skin, 1e-12);
    } else {
      ++made;
      EXPECT_EQ(scene.wear.used(p), 0.0);
    }
  });
  EXPECT_GT(kept, 0U);
  EXPECT_GT(made, 0U);
  EXPECT_EQ(scene.wear.whole(), 0.0);
}

}  // namespace
}  // namespace fexp::contact
