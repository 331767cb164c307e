// SPDX-License-Identifier: Apache-2.0
#include "solve/patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "model/build.hpp"
#include "model/mesh_order.hpp"
#include "model/patch_cut.hpp"
#include "solve/kernels.hpp"
#include "solve/workspace.hpp"
#include "support/descriptions.hpp"
#include "support/kernels.hpp"

namespace fexp::solve {
namespace {

/// A plate of several patches, and one of a single one.
model::Model two_plates(int cells) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "large", model::Plate{1.0, 1.0, cells, cells, "alternating"});
  test::add_body(d, "small", model::Plate{0.1, 0.1, 3, 3, "one"}).translate = {0.0, 0.0, 1.0};
  return test::build(d);
}

TEST(patches, hold_every_block_once_and_no_more_elements_than_fit) {
  const model::Model model = two_plates(50);
  const Patches cut(model);
  ASSERT_GT(cut.body_patches[0].size(), 5);
  EXPECT_EQ(cut.body_patches[1].size(), 1);
  Index block = 0, element = 0;
  for (const Patch& patch : cut.patches) {
    EXPECT_EQ(patch.blocks.begin, block);
    EXPECT_EQ(patch.elements.begin, element);
    EXPECT_GT(patch.elements.size(), 0);
    EXPECT_LE(patch.elements.size(), model::patch_elements);
    block = patch.blocks.end;
    element = patch.elements.end;
  }
  EXPECT_EQ(block, model.block_count());
  EXPECT_EQ(element, model.element_count());
}

TEST(patches, hold_every_node_once_and_all_corners_of_their_inner_nodes) {
  const model::Model model = two_plates(50);
  const Patches cut(model);
  std::vector<Index> times(at(model.node_count()), 0);
  for (const Patch& patch : cut.patches) {
    for (Index i = patch.nodes.begin; i < patch.nodes.end; ++i) {
      const Index node = cut.inner_node[at(i)];
      ++times[at(node)];
      for (Index c = model.corner_start[at(node)]; c < model.corner_start[at(node) + 1]; ++c) {
        EXPECT_TRUE(patch.elements.contains(model.corner[at(c)] / 3));
      }
    }
  }
  for (const Index node : cut.border_node) {
    ++times[at(node)];
  }
  EXPECT_EQ(std::ranges::count(times, 1), model.node_count());
  EXPECT_EQ(cut.body_border[1].size(), 0);
}

TEST(patches, give_every_share_of_the_border_a_place_in_the_order_of_patches) {
  const model::Model model = two_plates(50);
  const Patches cut(model);
  std::vector<Index> patch_at(at(cut.border_start.back()), no_index);
  for (std::size_t p = 0; p < cut.patches.size(); ++p) {
    const IndexRange border = cut.patches[p].border;
    for (Index i = border.begin; i < border.end; ++i) {
      EXPECT_EQ(patch_at[at(cut.border_place[at(i)])], no_index);
      patch_at[at(cut.border_place[at(i)])] = static_cast<Index>(p);
    }
  }
  for (std::size_t b = 0; b < cut.border_node.size(); ++b) {
    const auto first = patch_at.begin() + cut.border_start[b], last = patch_at.begin() + cut.border_start[b + 1];
    EXPECT_GE(last - first, 2);
    EXPECT_TRUE(std::ranges::is_sorted(first, last, std::ranges::less_equal{})) << "node " << cut.border_node[b];
    EXPECT_NE(*first, no_index);
  }
}

/// Every corner leads to the force on its own node, and lanes without an element to the last one.
TEST(patches, lead_corners_to_their_nodes) {
  const model::Model model = two_plates(33);
  const Patches cut(model);
  std::vector<Index> node_of_place(at(cut.border_start.back()));
  for (std::size_t b = 0; b < cut.border_node.size(); ++b) {
    std::fill(node_of_place.begin() + cut.border_start[b], node_of_place.begin() + cut.border_start[b + 1],
              cut.border_node[b]);
  }
  Index empty_lanes = 0;
  for (const Patch& patch : cut.patches) {
    std::vector<Index> node;  // of every force
    node.insert(node.end(), cut.inner_node.begin() + patch.nodes.begin, cut.inner_node.begin() + patch.nodes.end);
    for (Index i = patch.border.begin; i < patch.border.end; ++i) {
      node.push_back(node_of_place[at(cut.border_place[at(i)])]);
    }
    node.push_back(no_index);
    ASSERT_EQ(node.size(), at(patch.force_count()));
    ASSERT_LE(patch.force_count(), most_patch_forces);
    for (Index block = patch.blocks.begin; block < patch.blocks.end; ++block) {
      const model::ElementBlock& elements = model.blocks[at(block)];
      for (Index lane = 0; lane < model::block_lanes; ++lane) {
        for (std::size_t c = 0; c < 3; ++c) {
          const Index place = cut.corner[3 * at(block * model::block_lanes + lane) + c];
          const bool used = lane < elements.count;
          EXPECT_EQ(node[at(place)], used ? model.triangle[at(elements.first + lane)][c] : no_index);
          empty_lanes += used ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(empty_lanes, 0);
}

/// Whatever order a mesh file has its triangles in, few nodes lie on borders.
TEST(mesh_order, makes_patches_compact) {
  const model::Model model = two_plates(100);
  const Patches cut(model);
  // Squares of 16 cells a side would have an eighth of their nodes on borders.
  EXPECT_LT(static_cast<double>(cut.border_node.size()), 0.2 * model.node_count());
}

TEST(mesh_order, is_a_permutation_that_leaves_small_bodies_as_they_are) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Index count : {1, 512, 513, 5000}) {
    std::vector<Vec3d> position;
    std::vector<model::Triangle> triangle;
    std::vector<Index> order;
    for (Index t = 0; t < count; ++t) {
      // Many at the same place, which a cut by place alone could not tell apart.
      const Vec3d place = t % 2 == 0 ? Vec3d{} : Vec3d{unit(random), unit(random), unit(random)};
      position.insert(position.end(), 3, place);
      triangle.push_back({3 * t, 3 * t + 1, 3 * t + 2});
      order.push_back(t);
    }
    const std::vector<Index> before = order;
    model::order_by_place(position, triangle, order);
    EXPECT_EQ(order == before, count <= model::patch_elements);
    std::ranges::sort(order);
    EXPECT_EQ(order, before);
  }
}

TEST(mesh_order, leaves_the_user_his_numbers) {
  const model::Model model = two_plates(50);
  std::set<std::int64_t> labels;
  for (Index e = 0; e < model.bodies[0].elements.size(); ++e) {
    labels.insert(model.element_label[at(e)]);
    // Triangles of a plate: two a cell, cells row by row.
    const std::int64_t cell = model.element_label[at(e)] / 2;
    const Vec3d& corner = model.reference_position[at(model.triangle[at(e)][0])];
    EXPECT_NEAR(corner.x, (static_cast<double>(cell % 50) + 0.5) / 50.0, 0.011);
    EXPECT_NEAR(corner.y, (static_cast<double>(cell / 50) + 0.5) / 50.0, 0.011);
  }
  EXPECT_EQ(labels.size(), 5000U);
}

/// A plate whose file numbers nodes and triangles at random, with a group of the nodes at its left side.
model::Mesh shuffled_plate(int cells) {
  const model::Mesh sorted = model::generate_mesh(model::Plate{1.0, 1.0, cells, cells, "one"});
  std::mt19937 random(4);
  std::vector<Index> number(sorted.position.size());
  std::iota(number.begin(), number.end(), 0);
  std::ranges::shuffle(number, random);
  model::Mesh mesh = sorted;
  model::NodeGroup left{"left", {}};
  for (std::size_t n = 0; n < number.size(); ++n) {
    mesh.position[at(number[n])] = sorted.position[n];
    if (sorted.position[n].x == 0.0) {
      left.nodes.push_back(number[n]);
    }
  }
  for (std::size_t n = 0; n < number.size(); ++n) {
    mesh.node_label.push_back(1000 + static_cast<std::int64_t>(n));
  }
  for (model::Triangle& t : mesh.triangle) {
    for (Index& n : t) {
      n = number[at(n)];
    }
  }
  std::ranges::shuffle(mesh.triangle, random);
  std::ranges::sort(left.nodes);
  mesh.node_groups = {left};
  return mesh;
}

TEST(mesh_order, brings_nodes_near_each_other_together_and_leaves_labels_and_groups_to_them) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 60, 60, "one"});
  d.node_sets.emplace_back().name = "left";
  d.node_sets.back().group = "left";
  const model::Mesh mesh = shuffled_plate(60);
  ErrorList errors;
  const model::Model model = model::build_model(d, std::vector<model::Mesh>{mesh}, errors);
  ASSERT_TRUE(errors.empty());
  std::set<std::int64_t> labels;
  for (Index n = 0; n < model.node_count(); ++n) {
    const std::int64_t label = model.node_label[at(n)];
    labels.insert(label);
    EXPECT_EQ(norm(model.reference_position[at(n)] - mesh.position[static_cast<std::size_t>(label - 1000)]), 0.0);
  }
  EXPECT_EQ(labels.size(), mesh.position.size());
  const auto set = std::ranges::find(model.node_sets, "left", &model::NamedNodes::name);
  ASSERT_NE(set, model.node_sets.end());
  EXPECT_TRUE(std::ranges::is_sorted(set->nodes));
  EXPECT_EQ(set->nodes.size(), 61U);
  for (const Index n : set->nodes) {
    EXPECT_EQ(model.reference_position[at(n)].x, 0.0);
  }
  // In a file's order neighbours would be a third of all nodes apart on average.
  double apart = 0.0;
  for (const model::Triangle& t : model.triangle) {
    apart += std::abs(t[0] - t[1]);
  }
  EXPECT_LT(apart / static_cast<double>(model.triangle.size()), 0.05 * model.node_count());
}

TEST(mesh_order, puts_nodes_of_no_triangle_last) {
  std::vector<model::Triangle> triangle(at(model::patch_elements + 1), {4, 3, 1});
  EXPECT_EQ(model::node_numbers(6, triangle), (std::vector<Index>{3, 2, 4, 1, 0, 5}));
  triangle.pop_back();
  EXPECT_EQ(model::node_numbers(6, triangle), (std::vector<Index>{0, 1, 2, 3, 4, 5}));
}

/// Velocities that are not finite are told, at the end of the step or in the middle of the next, by every kernel.
TEST(node_kernels, tell_what_is_not_finite_and_when) {
  const model::Model model = two_plates(3);
  for (const SelectedKernel& kernel : test::kernels_here()) {
    SCOPED_TRACE(kernel.name);
    const Workspace workspace(model, kernel);
    const auto run = [&](double force, bool go_on) {
      model::State state = model::initial_state(model);
      std::vector<NodeForce> node_force(4);
      node_force[2].moment.z = force;
      std::vector<Index> nodes{0, 1, 2, 3};
      const NodeKernelArguments arguments{node_force.data(),
                                          nullptr,
                                          nullptr,
                                          workspace.inverse_inertia.data(),
                                          state.motion.data(),
                                          state.acceleration.data(),
                                          1.0e-3,
                                          2.0e-3,
                                          go_on};
      return kernel.nodes(arguments, nodes.data(), 0, 4);
    };
    const double inertia = model.inertia[2];
    // A rate whose square is nearly the largest number: half the step still has one, both halves have not.
    const double nearly = 1.2e154 / 1.0e-3 * inertia;
    EXPECT_TRUE(run(nearly, true).closing_finite);
    EXPECT_FALSE(run(nearly, true).opening_finite);
    EXPECT_TRUE(run(nearly, false).closing_finite);
    EXPECT_FALSE(run(2.0 * nearly, false).closing_finite);
    EXPECT_FALSE(run(HUGE_VAL, true).closing_finite);
    EXPECT_TRUE(run(1.0, true).opening_finite);
  }
}

}  // namespace
}  // namespace fexp::solve
