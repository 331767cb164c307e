// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "support/models.hpp"

namespace fexp::solve {
namespace {

/// A plate whose element count fills no block, moving and stressed at random.
struct RandomPlate {
  RandomPlate() : model(make()), state(model::initial_state(model)), corner_force(3 * model.triangle.size()) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&](double size) {
      return Vec3d{size * unit(random), size * unit(random), size * unit(random)};
    };
    for (model::NodeMotion& motion : state.motion) {
      motion.position += vector(0.02);
      motion.velocity = vector(50.0);
      motion.rotation_rate = vector(400.0);
    }
    for (double& value : state.history) {
      value = 1e4 * unit(random);
    }
    for (const model::SectionData& section : model.sections) {
      sections.emplace_back(physics::ShellSection{section.thickness, section.moduli, 0.1});
    }
  }

  static model::Model make() {
    auto d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
    test::add_body(d, "plate", model::Plate{1.0, 1.0, 9, 7, "one"});
    return test::build(d);
  }

  void step(ElementKernel kernel, double dt) {
    kernel({state.motion.data(), model.triangle.data(), model.blocks.data(), sections.data(), state.history.data(),
            corner_force.data(), 0, dt},
           0, model.block_count());
  }

  model::Model model;
  model::State state;
  std::vector<physics::ShellStiffness> sections;
  std::vector<CornerForce> corner_force;
};

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Elements whose history or corner forces differ in any bit.
int different_elements(const RandomPlate& a, const RandomPlate& b) {
  int different = 0;
  for (Index e = 0; e < a.model.element_count(); ++e) {
    bool same = true;
    for (Index row = 0; row < model::element_rows; ++row) {
      same = same && same_bits(model::element_value(a.model, a.state, e, static_cast<model::ElementRow>(row)),
                               model::element_value(b.model, b.state, e, static_cast<model::ElementRow>(row)));
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const CornerForce &p = a.corner_force[3 * at(e) + c], &q = b.corner_force[3 * at(e) + c];
      for (const auto& [u, v] : {std::pair{p.force, q.force}, std::pair{p.moment, q.moment}}) {
        same = same && same_bits(u.x, v.x) && same_bits(u.y, v.y) && same_bits(u.z, v.z);
      }
    }
    different += same ? 0 : 1;
  }
  return different;
}

TEST(element_kernels, of_every_width_give_the_bits_of_the_scalar_one) {
  RandomPlate scalar;
  ASSERT_NE(scalar.model.element_count() % model::block_lanes, 0) << "the last block must not be full";
  for (int i = 0; i < 3; ++i) {
    scalar.step(select_element_kernel(KernelChoice::scalar).elements, 1e-5);
  }
  int compared = 0;
  for (const KernelChoice choice : {KernelChoice::baseline, KernelChoice::avx2, KernelChoice::avx512}) {
    const SelectedKernel kernel = select_element_kernel(choice);
    if (kernel.elements == nullptr) {
      continue;  // this processor has no such instructions
    }
    RandomPlate packed;
    for (int i = 0; i < 3; ++i) {
      packed.step(kernel.elements, 1e-5);
    }
    EXPECT_EQ(different_elements(scalar, packed), 0) << kernel.name;
    ++compared;
  }
  EXPECT_GE(compared, 1);
}

TEST(element_kernels, leave_the_state_alone_when_no_time_passes) {
  RandomPlate moved;
  moved.step(select_element_kernel(KernelChoice::automatic).elements, 1e-5);
  RandomPlate still = moved;
  still.step(select_element_kernel(KernelChoice::automatic).elements, 0.0);
  EXPECT_EQ(different_elements(moved, still), 0);
}

}  // namespace
}  // namespace fexp::solve
