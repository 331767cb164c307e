// SPDX-License-Identifier: Apache-2.0
#include "model/cutout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "support/descriptions.hpp"

namespace fexp::model {
namespace {

Model strip() {
  Description d = test::description(test::steel, 0.01);
  test::add_body(d, "p", Plate{10.0, 1.0, 10, 1, "one"}).array = Array{{1, 2, 1}, {0.0, 3.0, 0.0}};
  return test::build(d);
}

double x_of(const Model& model, const State& state, Index element) {
  double sum = 0.0;
  for (const Index n : model.triangle[at(element)]) {
    sum += state.motion[at(n)].position.x;
  }
  return sum / 3.0;
}

TEST(cutout, has_the_closest_elements_the_one_itself_first_and_their_nodes_once) {
  const Model model = strip();
  const State state = initial_state(model);
  const Index element = 11;
  const Cutout cutout = neighbourhood(model, state, element, 6);
  ASSERT_EQ(cutout.elements.size(), 6U);
  EXPECT_EQ(cutout.elements[0], element);
  for (const Index e : cutout.elements) {
    EXPECT_LT(std::abs(x_of(model, state, e) - x_of(model, state, element)), 2.0) << e;
    EXPECT_EQ(model.blocks[at(model.element_block[at(e)])].body, 0);
  }
  EXPECT_EQ(std::set<Index>(cutout.nodes.begin(), cutout.nodes.end()).size(), cutout.nodes.size());
  for (std::size_t i = 0; i < cutout.elements.size(); ++i) {
    EXPECT_EQ(cutout.element_label[i], model.element_label[at(cutout.elements[i])]);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(cutout.nodes[at(cutout.triangle[i][a])], model.triangle[at(cutout.elements[i])][a]);
    }
  }
}

TEST(cutout, is_the_whole_of_a_smaller_model_with_what_is_nowhere_last) {
  const Model model = strip();
  State state = initial_state(model);
  const Index lost = model.triangle[3][0];
  state.motion[at(lost)].position.y = NAN;
  const Cutout cutout = neighbourhood(model, state, 30, 1000);
  ASSERT_EQ(static_cast<Index>(cutout.elements.size()), model.element_count());
  EXPECT_EQ(static_cast<Index>(cutout.nodes.size()), model.node_count());
  const auto& corners = model.triangle[at(cutout.elements.back())];
  EXPECT_NE(std::find(corners.begin(), corners.end(), lost), corners.end());
  // Where the element itself is nowhere, it still comes first.
  EXPECT_EQ(neighbourhood(model, state, 3, 2).elements.front(), 3);
}

TEST(cutout, of_a_frame_has_its_values) {
  const Model model = strip();
  State state = initial_state(model);
  for (Index n = 0; n < model.node_count(); ++n) {
    state.motion[at(n)].velocity.z = n;
  }
  state.step = 7;
  state.time = 0.5;
  const Cutout cutout = neighbourhood(model, state, 25, 5);
  const Frame cut = cut_out(capture(model, state, {}, {}), cutout);
  EXPECT_EQ(cut.step, 7);
  EXPECT_EQ(cut.time, 0.5);
  ASSERT_EQ(cut.velocity.size(), cutout.nodes.size());
  for (std::size_t i = 0; i < cutout.nodes.size(); ++i) {
    EXPECT_EQ(cut.velocity[i][2], static_cast<float>(cutout.nodes[i]));
    EXPECT_EQ(cut.position[i], state.motion[at(cutout.nodes[i])].position);
  }
  EXPECT_EQ(cut.body, std::vector<Index>(5, 1));
}

}  // namespace
}  // namespace fexp::model
