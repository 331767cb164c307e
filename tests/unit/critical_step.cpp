// SPDX-License-Identifier: Apache-2.0
#include "physics/critical_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "solve/diagnostics.hpp"
#include "support/descriptions.hpp"
#include "support/kernels.hpp"
#include "support/models.hpp"

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
    const physics::ShellSection shell{section.thickness, section.moduli, model.run.drilling};
    double step = physics::element_critical_step(shell, section.density, frame);
    if (section.layered.points.count > 0) {
      const double present = model::layer_value(model, state, e, physics::layer_thickness);
      const double thickness = model.run.stiffness_damping > 0.0 ? std::max(present, section.thickness) : present;
      step = physics::layered_critical_step(shell, section.density, thickness, model.reference_area[at(e)], frame);
    }
    found = smaller(found, {step > 0.0 ? step : 0.0, e});
  }
  return found;
}

/// A plate of metal in which every element has a thickness of its own.
struct UnevenPlate {
  explicit UnevenPlate(double stiffness_damping = 0.0) : model(make(stiffness_damping)), state(initial_state(model)) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> growth(0.4, 2.0), shift(-0.02, 0.02);
    for (Index e = 0; e < model.element_count(); ++e) {
      const model::ElementBlock& block = model.blocks[at(model.element_block[at(e)])];
      state.layers[(at(block.layer_row) + physics::layer_thickness) * at(model::block_lanes) + at(e - block.first)] *=
          growth(random);
    }
    for (model::NodeMotion& motion : state.motion) {
      motion.position += {shift(random), shift(random), shift(random)};
    }
  }
  static model::Model make(double stiffness_damping) {
    model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.05);
    d.materials[0].law = physics::J2Linear{{7850.0, 2.1e11, 0.3}, 250e6, 2e9};
    d.run.stiffness_damping = stiffness_damping;
    test::add_body(d, "plate", model::Plate{1.0, 1.0, 9, 7, "one"});
    return test::build(d);
  }

  model::Model model;
  model::State state;
};

TEST(critical_step, goes_by_the_thickness_that_elements_have_become) {
  for (const double damping : {0.0, 1e-6}) {
    const UnevenPlate plate(damping);
    const CriticalStep fast = body_critical_step(plate.model, plate.state, 0),
                       slow = one_by_one(plate.model, plate.state, 0);
    EXPECT_EQ(fast.step, slow.step) << damping;
    EXPECT_EQ(fast.element, slow.element) << damping;
    EXPECT_LT(fast.step, body_critical_step(plate.model, model::initial_state(plate.model), 0).step);
  }
  EXPECT_LE(body_critical_step(UnevenPlate(1e-6).model, UnevenPlate(1e-6).state, 0).step,
            body_critical_step(UnevenPlate().model, UnevenPlate().state, 0).step)
      << "damping has the thickness of the deck where the element is thinner";
}

/// At the start it is what the masses were made for, to the bit.
TEST(critical_step, of_layered_sections_begins_as_that_of_the_model) {
  const model::Model model = UnevenPlate::make(0.0);
  EXPECT_EQ(body_critical_step(model, model::initial_state(model), 0).step, model.first_critical_step);
}

/// A free plate whose elements are half as thick again as the deck has them, of which bending has the highest frequency
/// then: at its critical step what swings stays as it is, at the one of the thickness of the deck it grows without
/// bound.
TEST(critical_step, holds_a_plate_that_has_become_thicker) {
  model::Description d = test::description({7850.0, 2.1e11, 0.3}, 0.6);
  d.materials[0].law = physics::J2Linear{{7850.0, 2.1e11, 0.3}, 1e15, 0.0};
  test::add_body(d, "plate", model::Plate{0.2, 0.2, 1, 1, "one"});
  const model::Model model = test::build(d);
  const auto energy_after = [&](double part_of_critical, bool deck) {
    model::State state = model::initial_state(model);
    for (model::NodeMotion& motion : state.motion) {
      motion.position = std::sqrt(1.0 / 1.5) * motion.position;
    }
    CriticalStep critical = body_critical_step(model, state, 0);
    for (const model::ElementBlock& block : model.blocks) {
      for (Index lane = 0; lane < model::block_lanes; ++lane) {
        state.layers[(at(block.layer_row) + physics::layer_thickness) * at(model::block_lanes) + at(lane)] = 0.9;
      }
    }
    if (!deck) {
      critical = body_critical_step(model, state, 0);
    }
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(-1e-3, 1e-3);
    for (model::NodeMotion& motion : state.motion) {
      motion.velocity.z = 0.1 * unit(random);
      motion.rotation_rate = {unit(random), unit(random), 0.0};
    }
    const double before = diagnostics(model, state).energies.kinetic;
    test::DirectRun run(model, state);
    run.advance(part_of_critical * critical.step, 4000);
    return diagnostics(model, run.state).energies.kinetic / before;
  };
  EXPECT_LT(energy_after(0.9999, false), 1.01);
  EXPECT_FALSE(energy_after(0.9999, true) < 1e6) << "with the thickness of the deck";
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

void expect_same_by_every_kernel(const model::Model& model, const StepKernelArguments& arguments) {
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
  expect_same_by_every_kernel(model, {state.motion.data(), model.triangle.data(), model.blocks.data(),
                                      model.sections.data(), model.run.drilling});
  for (const bool damped : {false, true}) {
    const UnevenPlate uneven;
    expect_same_by_every_kernel(
        uneven.model, {uneven.state.motion.data(), uneven.model.triangle.data(), uneven.model.blocks.data(),
                       uneven.model.sections.data(), uneven.model.run.drilling, nullptr, uneven.state.layers.data(),
                       uneven.model.reference_area.data(), damped});
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
