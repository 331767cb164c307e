// SPDX-License-Identifier: Apache-2.0
#include "solve/kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "base/aligned_vector.hpp"
#include "solve/patches.hpp"
#include "support/kernels.hpp"
#include "support/models.hpp"

namespace fexp::solve {
namespace {

/// A plate whose element count fills no block, moving and stressed at random.
struct RandomPlate {
  explicit RandomPlate(const physics::AnyMaterial& law = physics::LinearElastic{7850.0, 2.1e11, 0.3})
      : model(make(law)),
        state(model::initial_state(model)),
        patches(model),
        force(at(patches.patches[0].force_count())) {
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
    // Stresses on both sides of the yield stress.
    for (Index e = 0; e < (model.sections[0].layer_rows() > 0 ? model.element_count() : 0); ++e) {
      const model::ElementBlock& block = model.blocks[at(model.element_block[at(e)])];
      const auto row = [&](Index r) -> double& {
        return state.layers[(at(block.layer_row) + at(r)) * at(model::block_lanes) + at(e - block.first)];
      };
      for (Index p = 0; p < model.sections[0].layered.points.count; ++p) {
        const Index first = physics::layer_points + p * physics::point_rows;
        for (const Index r : {physics::point_sum, physics::point_difference, physics::point_shear}) {
          row(first + r) = 4e8 * unit(random);
        }
        row(first + physics::point_strain) = e % 3 == 0 ? 0.0 : 0.1 * (1.0 + unit(random));
      }
      // From colder than the reference temperature to beyond melting, then rates.
      const physics::LayeredSection& section = model.sections[0].layered;
      for (Index r = section.temperature_row(0); r < section.rows(); ++r) {
        row(r) = 1000.0 * (1.0 + unit(random));
      }
    }
    for (const model::SectionData& section : model.sections) {
      sections.emplace_back(physics::ShellSection{section.thickness, section.moduli, 0.1});
    }
  }

  static model::Model make(const physics::AnyMaterial& law) {
    auto d = test::description({7850.0, 2.1e11, 0.3}, 0.003);
    d.materials[0].law = law;
    d.sections[0].points = 4;
    test::add_body(d, "plate", model::Plate{1.0, 1.0, 9, 7, "one"});
    return test::build(d);
  }

  void step(ElementKernel kernel, double dt) {
    std::ranges::fill(force, NodeForce{});
    kernel({state.motion.data(), model.triangle.data(), model.blocks.data(), sections.data(), state.history.data(),
            patches.corner.data(), force.data(), dt, model.sections.data(), state.layers.data(),
            damping > 0.0 ? state.damping.data() : nullptr, damping},
           0, model.block_count());
  }

  /// Stiffness damping from now on, with a share in the resultants already.
  void damp() {
    damping = 3e-6;
    state.damping = state.history;
    for (double& value : state.damping) {
      value *= 0.1;
    }
  }

  model::Model model;
  model::State state;
  std::vector<physics::ShellStiffness> sections;
  Patches patches;
  AlignedVector<NodeForce> force;
  double damping{};
};

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same_bits(const Vec3d& a, const Vec3d& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

/// Elements whose history and nodes whose forces differ in any bit.
int differences(const RandomPlate& a, const RandomPlate& b) {
  int different = 0;
  for (Index e = 0; e < a.model.element_count(); ++e) {
    bool same = true;
    for (Index row = 0; row < model::element_rows; ++row) {
      same = same && same_bits(model::element_value(a.model, a.state, e, static_cast<model::ElementRow>(row)),
                               model::element_value(b.model, b.state, e, static_cast<model::ElementRow>(row)));
    }
    const std::size_t first = at(a.model.element_block[at(e)]) * at(model::element_rows * model::block_lanes) +
                              at(e - a.model.blocks[at(a.model.element_block[at(e)])].first);
    for (Index row = 0; row < (a.state.damping.empty() ? 0 : model::element_rows); ++row) {
      const std::size_t place = first + at(row * model::block_lanes);
      same = same && same_bits(a.state.damping[place], b.state.damping[place]);
    }
    for (Index row = 0; row < a.model.sections[0].layer_rows(); ++row) {
      same =
          same && same_bits(model::layer_value(a.model, a.state, e, row), model::layer_value(b.model, b.state, e, row));
    }
    different += same ? 0 : 1;
  }
  for (std::size_t n = 0; n < at(a.model.node_count()); ++n) {
    different +=
        same_bits(a.force[n].force, b.force[n].force) && same_bits(a.force[n].moment, b.force[n].moment) ? 0 : 1;
  }
  return different;
}

/// Every law of the deck.
std::vector<physics::AnyMaterial> laws() {
  const physics::J2Law metal{7850.0, 2.1e11, 0.3, 0.02, 10.0};
  physics::J2Table table{metal, {}};
  table.table.append({0.0, 2e8});
  table.table.append({0.05, 3e8});
  table.table.append({0.15, 3.2e8});
  physics::JohnsonCook johnson_cook;
  static_cast<physics::J2Power&>(johnson_cook) = physics::J2Power{metal, 3e8, 2e8, 0.3};
  return {physics::LinearElastic{7850.0, 2.1e11, 0.3}, physics::J2Linear{metal, 3e8, 1e9},
          physics::J2Power{metal, 2e8, 3e8, 0.4}, table, johnson_cook};
}

/// The same, the plastic ones with heating, a filter of the rate, or both, and some that fail.
std::vector<physics::AnyMaterial> laws_with_conditions() {
  std::vector<physics::AnyMaterial> all = laws();
  for (std::size_t i = 1; i < all.size(); ++i) {
    std::visit(
        [i](auto& law) {
          if constexpr (requires { law.heating; }) {
            if (i != 1) {
              law.heating = physics::AdiabaticHeating{477.0, 1793.0, 293.0, 300.0, 1.03, 0.9};
            }
            law.rate_cutoff = i == 2 ? 0.0 : 1e4;
            law.failure_strain = i >= 3 ? 0.15 : -1.0;
            if (i == 3) {
              law.rate_sensitivity = 0.0;
              law.cowper_symonds = physics::CowperSymonds{40.0, 5.0};
            }
          }
        },
        all[i]);
  }
  all.erase(all.begin());
  return all;
}

void expect_same_bits_by_every_kernel(const std::vector<physics::AnyMaterial>& all) {
  for (std::size_t k = 0; k < 2 * all.size(); ++k) {
    const physics::AnyMaterial law = all[k / 2];
    const bool damped = k % 2 == 1;
    SCOPED_TRACE(std::to_string(law.index()) + (damped ? " damped" : ""));
    RandomPlate scalar(law);
    if (damped) {
      scalar.damp();
    }
    ASSERT_NE(scalar.model.element_count() % model::block_lanes, 0) << "the last block must not be full";
    for (int i = 0; i < 3; ++i) {
      scalar.step(select_element_kernel(KernelChoice::scalar).elements, 1e-5);
    }
    EXPECT_TRUE(scalar.state.layers.empty() || differences(scalar, RandomPlate(law)) > 100);
    ASSERT_GE(test::kernels_here().size(), 2U);
    for (const SelectedKernel& kernel : test::kernels_here()) {
      RandomPlate packed(law);
      if (damped) {
        packed.damp();
      }
      for (int i = 0; i < 3; ++i) {
        packed.step(kernel.elements, 1e-5);
      }
      EXPECT_EQ(differences(scalar, packed), 0) << kernel.name;
    }
  }
}

TEST(element_kernels, of_every_width_give_the_bits_of_the_scalar_one_with_every_law) {
  static_assert(std::variant_size_v<physics::AnyMaterial> == 5, "laws() has all of them");
  expect_same_bits_by_every_kernel(laws());
}

TEST(element_kernels, of_every_width_give_the_bits_of_the_scalar_one_with_heat_and_filters) {
  for (const physics::AnyMaterial& law : laws_with_conditions()) {
    ASSERT_TRUE(RandomPlate(law).model.sections[0].layered.has_conditions());
  }
  expect_same_bits_by_every_kernel(laws_with_conditions());
}

/// Forces of several elements on a node are those of each alone, added in their order.
TEST(element_kernels, add_corner_forces_in_the_order_of_elements) {
  for (const SelectedKernel& kernel : test::kernels_here()) {
    SCOPED_TRACE(kernel.name);
    RandomPlate all;
    const RandomPlate before = all;
    all.step(kernel.elements, 1e-5);
    // A place of its own for every corner: no two are added.
    const auto corners = 3 * at(model::block_lanes) * at(all.model.block_count());
    std::vector<std::uint16_t> place(corners);
    std::iota(place.begin(), place.end(), std::uint16_t{0});
    AlignedVector<NodeForce> corner(corners);
    model::State state = before.state;
    kernel.elements({state.motion.data(), all.model.triangle.data(), all.model.blocks.data(), all.sections.data(),
                     state.history.data(), place.data(), corner.data(), 1e-5},
                    0, all.model.block_count());
    std::vector<NodeForce> sum(at(all.model.node_count()));
    for (Index e = 0; e < all.model.element_count(); ++e) {
      for (std::size_t c = 0; c < 3; ++c) {
        NodeForce& node = sum[at(all.model.triangle[at(e)][c])];
        node.force += corner[3 * at(e) + c].force;
        node.moment += corner[3 * at(e) + c].moment;
      }
    }
    for (std::size_t n = 0; n < sum.size(); ++n) {
      EXPECT_TRUE(same_bits(all.force[n].force, sum[n].force)) << n;
      EXPECT_TRUE(same_bits(all.force[n].moment, sum[n].moment)) << n;
    }
  }
}

TEST(element_kernels, leave_the_state_alone_when_no_time_passes) {
  for (const physics::AnyMaterial& law : laws()) {
    RandomPlate moved(law);
    moved.step(select_element_kernel(KernelChoice::automatic).elements, 1e-5);
    RandomPlate still = moved;
    still.step(select_element_kernel(KernelChoice::automatic).elements, 0.0);
    EXPECT_EQ(differences(moved, still), 0) << law.index();
    // What damping adds is remembered, as its rates are not known any more.
    moved.damp();
    moved.step(select_element_kernel(KernelChoice::automatic).elements, 1e-5);
    still = moved;
    still.step(select_element_kernel(KernelChoice::automatic).elements, 0.0);
    EXPECT_EQ(differences(moved, still), 0) << law.index();
  }
}

}  // namespace
}  // namespace fexp::solve
