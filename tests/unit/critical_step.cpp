// SPDX-License-Identifier: Apache-2.0
#include "physics/critical_step.hpp"

#include <gtest/gtest.h>

#include <random>

#include "solve/diagnostics.hpp"
#include "support/descriptions.hpp"
#include "support/kernels.hpp"

namespace fexp::solve {
namespace {

/// Elements one by one: the slow twin.
CriticalStep one_by_one(const model::Model& model, const model::State& state, Index body) {
  CriticalStep found;
  for (Index e = model.bodies[at(body)].elements.begin; e < model.bodies[at(body)].elements.end; ++e) {
    const auto& t = model.triangle[at(e)];
    const Vec3d& origin = state.motion[at(t[0])].position;
    const auto frame =
        physics::triangle_frame(state.motion[at(t[1])].position - origin, state.motion[at(t[2])].position - origin);
    const model::SectionData& section = model.section_of(e);
    const double step =
        physics::element_critical_step({section.thickness, section.moduli, model.run.drilling}, section.density, frame);
    found = smaller(found, {step > 0.0 ? step : 0.0, e});
  }
  return found;
}

TEST(critical_step, of_a_body_is_to_the_bit_that_of_its_elements_one_by_one) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "large", model::Plate{1.0, 1.0, 31, 37, "alternating"});
  test::add_body(d, "small", model::Plate{1.0, 1.0, 1, 1, "one"}).translate = {0.0, 0.0, 1.0};
  const model::Model model = test::build(d);
  std::mt19937 random(7);
  for (const double distortion : {0.0, 0.003, 0.03, 0.3}) {
    model::State state = model::initial_state(model);
    std::uniform_real_distribution<double> shift(-distortion, distortion);
    for (model::NodeMotion& motion : state.motion) {
      motion.position += {shift(random), shift(random), shift(random)};
    }
    for (const Index body : {0, 1}) {
      const CriticalStep fast = body_critical_step(model, state, body), slow = one_by_one(model, state, body);
      EXPECT_EQ(fast.step, slow.step) << distortion;
      EXPECT_EQ(fast.element, slow.element) << distortion;
    }
  }
}

/// By every kernel, at blocks of which not all lanes have an element and in which some have collapsed.
TEST(critical_step, is_the_same_by_every_kernel) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 9, 7, "one"});
  const model::Model model = test::build(d);
  ASSERT_NE(model.element_count() % model::block_lanes, 0);
  model::State state = model::initial_state(model);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> shift(-0.02, 0.02);
  for (model::NodeMotion& motion : state.motion) {
    motion.position += {shift(random), shift(random), shift(random)};
  }
  const auto& t = model.triangle[77];
  state.motion[at(t[1])].position = state.motion[at(t[0])].position;
  const StepKernelArguments arguments{state.motion.data(), model.triangle.data(), model.blocks.data(),
                                      model.sections.data(), model.run.drilling};
  const StepKernel scalar = select_element_kernel(KernelChoice::scalar).steps;
  ASSERT_GE(test::kernels_here().size(), 2U);
  for (const SelectedKernel& kernel : test::kernels_here()) {
    for (Index block = 0; block < model.block_count(); ++block) {
      const CriticalStep expected = scalar(arguments, block, block + 1),
                         found = kernel.steps(arguments, block, block + 1);
      EXPECT_EQ(found.step, expected.step) << kernel.name << ", block " << block;
      EXPECT_EQ(found.element, expected.element) << kernel.name << ", block " << block;
    }
  }
}

TEST(critical_step, is_zero_where_an_element_has_collapsed) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 5, 5, "one"});
  const model::Model model = test::build(d);
  model::State state = model::initial_state(model);
  const auto& t = model.triangle[13];
  state.motion[at(t[1])].position = state.motion[at(t[0])].position;
  const CriticalStep fast = body_critical_step(model, state, 0), slow = one_by_one(model, state, 0);
  EXPECT_EQ(fast.step, 0.0);
  EXPECT_EQ(fast.element, slow.element);
}

}  // namespace
}  // namespace fexp::solve
