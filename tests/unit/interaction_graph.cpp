// SPDX-License-Identifier: Apache-2.0
#include "cluster/interaction_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace fexp::cluster {
namespace {

model::Model bodies(Index count) {
  model::Model model;
  model.bodies.resize(at(count));
  return model;
}

Box cube(double x, double y, double z, double half) { return Box{{x, y, z}, {x, y, z}}.grown(half); }

/// The definition itself: union-find over all pairs.
std::vector<Island> islands_by_definition(const model::Model& model, const std::vector<Box>& swept) {
  std::vector<Index> root(swept.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](Index i) {
    while (root[at(i)] != i) {
      i = root[at(i)];
    }
    return i;
  };
  const auto touch = [&](Index a, Index b) {
    return swept[at(a)].overlaps(swept[at(b)]) && model.can_touch(std::min(a, b), std::max(a, b));
  };
  const Index count = model.body_count();
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < a; ++b) {
      if (!model.bodies[at(a)].barrier && !model.bodies[at(b)].barrier && touch(a, b)) {
        // The lower root becomes the root of both.
        const auto [low, high] = std::minmax({find(a), find(b)});
        root[at(high)] = low;
      }
    }
  }
  std::vector<Island> islands;
  for (Index lowest = 0; lowest < count; ++lowest) {
    if (model.bodies[at(lowest)].barrier || find(lowest) != lowest) {
      continue;
    }
    Island& island = islands.emplace_back();
    for (Index b = 0; b < count; ++b) {
      if (!model.bodies[at(b)].barrier && find(b) == lowest) {
        island.bodies.push_back(b);
      }
    }
    for (Index barrier = 0; barrier < count; ++barrier) {
      if (model.bodies[at(barrier)].barrier &&
          std::ranges::any_of(island.bodies, [&](Index b) { return touch(b, barrier); })) {
        island.barriers.push_back(barrier);
      }
    }
  }
  return islands;
}

TEST(interaction_graph, islands_are_the_components_that_the_definition_gives) {
  std::mt19937 random(5);
  int merged = 0, with_barriers = 0;
  for (int round = 0; round < 400; ++round) {
    const Index count = std::uniform_int_distribution<Index>(0, 60)(random);
    const double half = std::uniform_real_distribution<double>(0.0, 0.15)(random);
    const double flatness = round % 3 == 0 ? 0.0 : 1.0;  // every third round in a plane
    model::Model model = bodies(count);
    std::uniform_real_distribution<double> place(0.0, 1.0);
    std::vector<Box> swept;
    for (model::Body& body : model.bodies) {
      body.barrier = place(random) < 0.1;
      swept.push_back(cube(place(random), place(random), flatness * place(random), half * place(random)));
    }
    for (Index a = 0; a < count; ++a) {
      for (Index b = a; b < count; ++b) {
        if (place(random) < 0.2) {
          model.excluded_pairs.emplace_back(a, b);
        }
      }
    }
    const std::vector<Island> islands = find_islands(model, swept);
    ASSERT_EQ(islands, islands_by_definition(model, swept)) << "round " << round;
    for (const Island& island : islands) {
      merged += island.bodies.size() > 1 ? 1 : 0;
      with_barriers += island.barriers.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(merged, 200);
  EXPECT_GT(with_barriers, 100);
}

TEST(interaction_graph, boxes_that_share_a_face_an_edge_or_a_corner_touch) {
  const model::Model model = bodies(2);
  for (const Vec3d& other : {Vec3d{2, 0, 0}, Vec3d{2, 2, 0}, Vec3d{2, 2, 2}, Vec3d{0, 0, -2}}) {
    EXPECT_EQ(find_islands(model, std::vector{cube(0, 0, 0, 1), cube(other.x, other.y, other.z, 1)}).size(), 1U);
    EXPECT_EQ(
        find_islands(model, std::vector{cube(0, 0, 0, 1), cube(1.0000001 * other.x, other.y, 1.0000001 * other.z, 1)})
            .size(),
        2U);
  }
}

TEST(interaction_graph, a_chain_is_one_island_until_a_link_is_excluded) {
  model::Model model = bodies(5);
  std::vector<Box> swept;
  for (const double x : {4.0, 0.0, 2.0, 1.0, 3.0}) {
    swept.push_back(cube(x, 0, 0, 0.6));
  }
  EXPECT_EQ(find_islands(model, swept), (std::vector<Island>{{{0, 1, 2, 3, 4}, {}}}));
  model.excluded_pairs = {{2, 4}};
  EXPECT_EQ(find_islands(model, swept), (std::vector<Island>{{{0, 4}, {}}, {{1, 2, 3}, {}}}));
}

TEST(interaction_graph, a_barrier_belongs_to_all_that_may_touch_it_and_joins_none) {
  model::Model model = bodies(4);
  model.bodies[1].barrier = true;
  const std::vector<Box> swept{cube(-3, 0, 0, 1), Box{{-10, -10, -1}, {10, 10, -0.5}}, cube(3, 0, 0, 1),
                               cube(0, 0, 5, 1)};
  EXPECT_EQ(find_islands(model, swept), (std::vector<Island>{{{0}, {1}}, {{2}, {1}}, {{3}, {}}}));
}

TEST(interaction_graph, without_contact_every_body_is_an_island) {
  model::Model model = bodies(3);
  model.contact.enabled = false;
  model.bodies[2].barrier = true;
  const std::vector<Box> swept(3, cube(0, 0, 0, 1));
  EXPECT_EQ(find_islands(model, swept), (std::vector<Island>{{{0}, {}}, {{1}, {}}}));
}

}  // namespace
}  // namespace fexp::cluster
