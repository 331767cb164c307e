// SPDX-License-Identifier: Apache-2.0
#include "contact/near_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "physics/closest_lines.hpp"

namespace fexp::contact {
namespace {

/// Edges between few points, so that many share one; some are parallel, some have no length, some lie in one plane.
std::vector<NearEdge> random_edges(std::mt19937& random, Index count, Index first_number, double skin, bool flat) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<NearEdge> edges;
  for (Index e = 0; e < count; ++e) {
    NearEdge edge;
    edge.number = first_number + 2 * e;
    edge.node = {static_cast<Index>(40.0 * unit(random)), static_cast<Index>(40.0 * unit(random))};
    edge.begin = {unit(random), unit(random), flat ? 0.0 : 0.3 * unit(random)};
    const double kind = unit(random);
    if (kind < 0.1) {
      edge.end = edge.begin;
    } else if (kind < 0.3) {
      edge.end = edge.begin + Vec3d{0.0, 0.4, 0.0};
    } else {
      edge.end = {unit(random), unit(random), flat ? 0.0 : 0.3 * unit(random)};
    }
    edge.reach = 0.05 * unit(random);
    edge.half_reach = edge.reach + 0.5 * skin;
    edges.push_back(edge);
  }
  return edges;
}

bool share_a_node(const NearEdge& a, const NearEdge& b) {
  return a.node[0] == b.node[0] || a.node[0] == b.node[1] || a.node[1] == b.node[0] || a.node[1] == b.node[1];
}

TEST(near_edges, of_every_kernel_are_those_of_exact_distances) {
  std::mt19937 random(3);
  std::size_t all = 0, none = 0;
  for (int i = 0; i < 2000; ++i) {
    const double skin = 0.02 * (i % 8);
    const bool flat = i % 4 == 0, same = i % 5 == 0;
    const std::vector<NearEdge> own = random_edges(random, 1 + i % most_edges, 100, skin, flat);
    const std::vector<NearEdge> others = same ? own : random_edges(random, 1 + i % 13, 95 + i % 80, skin, flat);
    BlockEdges block;  // NOLINT(cppcoreguidelines-pro-type-member-init): make_ready fills it
    make_ready(own, block);
    std::vector<NearEdgePair> first;
    for (const NearEdgeKernel kernel : near_edge_kernels()) {
      std::vector<NearEdgePair> found(at(most_edges) * others.size());
      found.resize(at(kernel(block, others.data(), static_cast<Index>(others.size()), skin, found.data())));
      auto next = found.cbegin();
      for (std::size_t e = 0; e < others.size(); ++e) {
        for (std::size_t lane = 0; lane < own.size(); ++lane) {
          const NearEdge &a = own[lane], &b = others[e];
          const double distance = std::sqrt(physics::edge_distance2(a.begin, a.end, b.begin, b.end));
          const double slack = distance - a.reach - b.reach;
          const bool is_found =
              next != found.cend() && next->edge == static_cast<Index>(e) && next->lane == static_cast<Index>(lane);
          if (share_a_node(a, b) || b.number <= a.number || slack > skin + 1e-7) {
            ASSERT_FALSE(is_found) << "scene " << i;
            ++none;
          } else if (slack < skin - 1e-7) {
            ASSERT_TRUE(is_found) << "scene " << i;
            ASSERT_NEAR(next->slack, slack, 2e-8) << "scene " << i;
            ++all;
          }
          if (is_found) {
            ++next;
          }
        }
      }
      ASSERT_EQ(next, found.cend());
      if (kernel == near_edge_kernels().front()) {
        first = found;
      }
      ASSERT_EQ(first.size(), found.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        ASSERT_EQ(first[k].slack, found[k].slack);
      }
    }
  }
  EXPECT_GT(all, 10'000U);
  EXPECT_GT(none, 10'000U);
}

}  // namespace
}  // namespace fexp::contact
