// SPDX-License-Identifier: Apache-2.0
#include "physics/through_thickness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fexp::physics {
namespace {

/// Mean of x^power over [-1, 1] by a rule.
double mean_of_power(const ThroughThickness& rule, int power) {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rule.count); ++i) {
    sum += rule.weight[i] * std::pow(rule.position[i], power);
  }
  return sum;
}

double exact_mean(int power) { return power % 2 == 0 ? 1.0 / (power + 1) : 0.0; }

void expect_exact_to_degree(const ThroughThickness& rule, int degree) {
  for (int power = 0; power <= degree; ++power) {
    EXPECT_NEAR(mean_of_power(rule, power), exact_mean(power), 2e-15) << rule.count << " points, power " << power;
  }
  EXPECT_GT(std::abs(mean_of_power(rule, degree + 1) - exact_mean(degree + 1)), 1e-7) << rule.count << " points";
  for (std::size_t i = 0; i < static_cast<std::size_t>(rule.count); ++i) {
    EXPECT_EQ(rule.position[i], -rule.position[static_cast<std::size_t>(rule.count) - 1 - i]);
    EXPECT_TRUE(i == 0 || rule.position[i] > rule.position[i - 1]);
  }
}

TEST(through_thickness, gauss_is_exact_for_twice_its_points_less_one) {
  for (int count = 1; count <= most_points; ++count) {
    expect_exact_to_degree(through_thickness(Quadrature::gauss, count), 2 * count - 1);
  }
}

TEST(through_thickness, lobatto_has_the_surfaces_and_is_exact_for_two_degrees_less) {
  for (int count = fewest_lobatto_points; count <= most_points; ++count) {
    const ThroughThickness rule = through_thickness(Quadrature::lobatto, count);
    expect_exact_to_degree(rule, 2 * count - 3);
    EXPECT_EQ(rule.position[0], -1.0);
  }
}

TEST(through_thickness, has_the_points_of_the_books) {
  EXPECT_NEAR(through_thickness(Quadrature::gauss, 3).position[2], std::sqrt(0.6), 2e-16);
  EXPECT_NEAR(through_thickness(Quadrature::gauss, 5).position[4], 0.906179845938664, 1e-15);
  EXPECT_NEAR(through_thickness(Quadrature::lobatto, 4).position[2], std::sqrt(0.2), 2e-16);
  EXPECT_NEAR(through_thickness(Quadrature::lobatto, 5).weight[2], 16.0 / 45.0, 2e-16);
}

}  // namespace
}  // namespace fexp::physics
