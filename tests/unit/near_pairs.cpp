// SPDX-License-Identifier: Apache-2.0
#include "contact/near_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "physics/closest_point.hpp"

namespace fexp::contact {
namespace {

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const double length2 = dot(b - a, b - a);
  const double part = length2 > 0.0 ? std::clamp(dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0;
  return norm(p - (a + part * (b - a)));
}

/// Also of triangles that are a point, which physics::closest_point does not know.
double distance_to_triangle(const Vec3d& p, const std::array<Vec3d, 3>& x) {
  const double inside = std::sqrt(physics::closest_point(p, x[0], x[1], x[2]).distance2);
  const double edges = std::min(
      {distance_to_segment(p, x[0], x[1]), distance_to_segment(p, x[1], x[2]), distance_to_segment(p, x[2], x[0])});
  return inside < edges ? inside : edges;
}

/// A block of triangles of its own nodes, and nodes that are looked for behind them.
struct Scene {
  std::vector<model::NodeMotion> motion;
  std::vector<std::array<Index, 3>> triangle;
  std::vector<double> half_thickness;
  std::vector<NearNode> nodes;
  std::vector<bool> degenerate;  // [lanes]: such may be taken for nearer than they are
  double skin{};
  model::ElementBlock block{};

  [[nodiscard]] SearchGeometry geometry() const {
    return {motion.data(), triangle.data(), half_thickness.data(), skin};
  }
  [[nodiscard]] std::vector<NearPair> found_by(const NearKernel& kernel) const {
    BlockTriangles triangles{};
    kernel.prepare(geometry(), block, triangles);
    std::vector<NearPair> found(nodes.size() * at(model::block_lanes));
    const Index count = kernel.find(triangles, nodes.data(), static_cast<Index>(nodes.size()), skin, found.data());
    found.resize(at(count));
    return found;
  }
  [[nodiscard]] double slack(const NearNode& node, Index lane) const {
    const auto& t = triangle[at(block.first + lane)];
    const auto x = [&](std::size_t c) { return motion[at(t[c])].position; };
    double half = 0.0;
    for (const Index n : t) {
      half = std::max(half, half_thickness[at(n)]);
    }
    return distance_to_triangle(node.point, {x(0), x(1), x(2)}) - node.reach - half;
  }
};

/// Random triangles, of which some are slivers and some have no area or no extent, `flatness` times as high as wide.
Scene random_scene(std::mt19937& random, Index triangles, double flatness) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto place = [&] { return Vec3d{unit(random), unit(random), flatness * unit(random)}; };
  Scene scene;
  scene.skin = 0.2 * unit(random);
  scene.block = {2, triangles, 0, 0};
  scene.triangle.assign(2, {0, 0, 0});
  for (Index e = 0; e < triangles; ++e) {
    const auto first = static_cast<Index>(scene.motion.size());
    scene.triangle.push_back({first, first + 1, first + 2});
    std::array<Vec3d, 3> x{place(), place(), place()};
    const double kind = unit(random);
    if (kind < 0.1) {
      x[2] = x[0] + 0.3 * (x[1] - x[0]);
    } else if (kind < 0.2) {
      x[2] = x[0] + 0.3 * (x[1] - x[0]) + Vec3d{1e-9, 0.0, 1e-9};
    } else if (kind < 0.25) {
      x[1] = x[0];
    } else if (kind < 0.3) {
      x = {x[0], x[0], x[0]};
    }
    scene.degenerate.push_back(kind < 0.3);
    for (const Vec3d& p : x) {
      scene.motion.emplace_back().position = p;
      scene.half_thickness.push_back(0.05 * unit(random));
    }
  }
  for (int i = 0; i < 24; ++i) {
    const double kind = unit(random);
    const auto corner = static_cast<Index>(unit(random) * static_cast<double>(scene.motion.size()));
    NearNode node{place(), 0.1 * unit(random), static_cast<Index>(scene.motion.size()) + i, i};
    if (kind < 0.2) {
      node.point = scene.motion[at(corner)].position;  // Of another node at the same place
    } else if (kind < 0.4) {
      node.point = scene.motion[at(corner)].position;
      node.node = corner;
    } else if (kind < 0.5) {
      node.point.z = 0.0;
    }
    scene.nodes.push_back(node);
  }
  return scene;
}

TEST(near_pairs, of_every_kernel_are_those_of_exact_distances) {
  std::mt19937 random(11);
  std::size_t all = 0, none = 0;
  for (int i = 0; i < 3000; ++i) {
    const Scene scene = random_scene(random, 1 + i % 8, i % 4 == 0 ? 0.0 : 1.0);
    for (const NearKernel& kernel : near_kernels()) {
      std::vector<NearPair> found = scene.found_by(kernel);
      auto next = found.begin();
      for (Index n = 0; n < static_cast<Index>(scene.nodes.size()); ++n) {
        const NearNode& node = scene.nodes[at(n)];
        for (Index lane = 0; lane < scene.block.count; ++lane) {
          const auto& t = scene.triangle[at(scene.block.first + lane)];
          const bool own = t[0] == node.node || t[1] == node.node || t[2] == node.node;
          const double slack = scene.slack(node, lane);
          const bool listed = next != found.end() && next->node == n && next->lane == lane;
          const bool exact = !scene.degenerate[at(lane)];
          if (own || (exact && slack > scene.skin + 1e-7)) {
            ASSERT_FALSE(listed) << slack - scene.skin;
            ++none;
          } else if (slack < scene.skin) {
            ASSERT_TRUE(listed) << slack - scene.skin;
          }
          if (listed) {
            ASSERT_LE(next->slack, slack);
            ASSERT_TRUE(!exact || next->slack > slack - 1e-7);
            ++next;
            ++all;
          }
        }
      }
      ASSERT_EQ(next, found.end());
    }
  }
  EXPECT_GT(all, 10000U);
  EXPECT_GT(none, 10000U);
}

TEST(near_pairs, of_all_kernels_are_the_same_bits) {
  std::mt19937 random(12);
  for (int i = 0; i < 1000; ++i) {
    const Scene scene = random_scene(random, 1 + i % 8, 1.0);
    const std::vector<NearPair> first = scene.found_by(near_kernels().front());
    for (const NearKernel& kernel : near_kernels()) {
      const std::vector<NearPair> found = scene.found_by(kernel);
      ASSERT_EQ(found.size(), first.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        ASSERT_EQ(found[k].node, first[k].node);
        ASSERT_EQ(found[k].lane, first[k].lane);
        ASSERT_EQ(found[k].slack, first[k].slack);
      }
    }
  }
}

}  // namespace
}  // namespace fexp::contact
