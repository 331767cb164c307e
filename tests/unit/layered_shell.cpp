// SPDX-License-Identifier: Apache-2.0
#include "physics/layered_shell.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/layered.hpp"

namespace fexp::physics {
namespace {

const J2Linear yielding_steel{{7850.0, 200e9, 0.3}, 250e6, 2e9};

ShellIncrement<double> increment(double size) {
  return {size * 1.0, size * -0.3, size * 0.7,
          size * 2.0, size * 1.1,  size * -0.9,
          size * 0.2, size * -0.4, {size * 0.1, size * 0.2, size * -0.3}};
}

/// As long as nothing yields the section is that of the elastic law but for the change of thickness, which is of the
/// order of the strains.
TEST(layered_shell, is_the_elastic_shell_below_the_yield_stress) {
  for (const auto& [rule, count] :
       {std::pair{Quadrature::gauss, 2}, {Quadrature::gauss, 5}, {Quadrature::lobatto, 3}, {Quadrature::lobatto, 8}}) {
    test::LayeredDriver<J2Linear> layered(yielding_steel, 0.01, count, rule);
    ShellResultants<double> elastic{};
    for (int i = 0; i < 10; ++i) {
      layered.step(increment(1e-6));
      update_elastic(layered.stiffness(), 1.0, increment(1e-6), elastic);
    }
    const ShellResultants<double>& s = layered.resultants;
    EXPECT_NEAR(s.nxx, elastic.nxx, 3e-5 * elastic.nxx);
    EXPECT_NEAR(s.nxy, elastic.nxy, 3e-5 * elastic.nxy);
    EXPECT_NEAR(s.mxx, elastic.mxx, 3e-5 * elastic.mxx);
    EXPECT_NEAR(s.myy, elastic.myy, 3e-5 * elastic.myy);
    EXPECT_EQ(s.qxz, elastic.qxz);
    EXPECT_EQ(s.drill[1], elastic.drill[1]);
    EXPECT_NEAR(s.energy, elastic.energy, 3e-5 * elastic.energy);
    EXPECT_EQ(layered.row(layer_dissipation), 0.0);
  }
}

/// Plastic flow keeps the volume: the thickness follows the membrane strains of a sheet that is stretched far beyond
/// the yield stress, less the elastic volume.
TEST(layered_shell, thins_as_it_is_stretched) {
  const J2Linear soft{{1.0, 200e9, 0.3}, 1e6, 0.0};
  test::LayeredDriver<J2Linear> layered(soft, 0.01, 3);
  for (int i = 0; i < 400; ++i) {
    layered.step({0.001, 0.0005, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {}});
  }
  EXPECT_NEAR(layered.row(layer_thickness), 0.01 * std::exp(-0.6), 1e-5 * 0.01);
}

/// Energy that was put in is stored elastically or dissipated.
TEST(layered_shell, internal_energy_is_elastic_energy_and_dissipation) {
  test::LayeredDriver<J2Linear> layered(yielding_steel, 0.01, 5);
  // Stretched, bent and brought back until nothing is left of the resultants in the middle of a step.
  for (int i = 0; i < 20000; ++i) {
    layered.step({1e-6, -3e-7, 0.0, 2e-4, 0.0, 0.0, 0.0, 0.0, {}});
  }
  const ShellResultants<double>& s = layered.resultants;
  double elastic = 0.0;
  for (int i = 0; i < 5; ++i) {
    const int row = layer_points + i * point_rows;
    const double mean = 0.5 * layered.row(row + point_sum), half = 0.5 * layered.row(row + point_difference);
    const double xx = mean + half, yy = mean - half;
    elastic += through_thickness(Quadrature::gauss, 5).weight[static_cast<std::size_t>(i)] *
               (xx * xx + yy * yy - 2.0 * 0.3 * xx * yy) / (2.0 * 200e9);
  }
  elastic *= layered.row(layer_thickness);
  EXPECT_GT(layered.row(layer_dissipation), 5.0 * elastic);
  EXPECT_NEAR(s.energy, elastic + layered.row(layer_dissipation), 3e-2 * s.energy)
      << "to the change of thickness, which is of the order of the strains";
}

/// Stresses turn with the material: a sheet with stress in x, sheared forwards and back elastically in large steps of
/// turning, keeps the length of its stress tensor as the resultants of the elastic shell do.
TEST(layered_shell, stresses_turn_as_the_resultants_of_the_elastic_shell) {
  const J2Linear hard{{1.0, 200e9, 0.3}, 1e15, 0.0};
  test::LayeredDriver<J2Linear> layered(hard, 0.01, 3);
  ShellResultants<double> elastic{};
  const ShellIncrement<double> pull{1e-6, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 0.0, {}};
  const ShellIncrement<double> shear{0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 1e-6, 0.0, {}};
  for (const auto& e : {pull, shear, shear, pull}) {
    layered.step(e);
    update_elastic(layered.stiffness(), 1.0, e, elastic);
  }
  const double h = layered.row(layer_thickness) / 0.01;
  EXPECT_NEAR(layered.resultants.nxx, h * elastic.nxx, 1e-12 * std::abs(elastic.nxy));
  EXPECT_NEAR(layered.resultants.mxx, h * h * elastic.mxx, 1e-5 * std::abs(elastic.mxx));
  EXPECT_NEAR(layered.resultants.mxy, h * h * elastic.mxy, 1e-5 * std::abs(elastic.mxx));
}

}  // namespace
}  // namespace fexp::physics
