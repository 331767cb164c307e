// SPDX-License-Identifier: Apache-2.0
#include "io/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fexp::io {
namespace {

TEST(convergence, finds_the_order_towards_a_reference) {
  for (const double order : {0.5, 1.0, 2.0}) {
    const MeshResult coarse{4.0, 3.0 + std::pow(4.0, -order)}, fine{12.0, 3.0 + std::pow(12.0, -order)};
    EXPECT_NEAR(order_towards(3.0, coarse, fine).value(), order, 1e-12);
  }
  EXPECT_LT(order_towards(0.0, {1.0, 1.0}, {2.0, 4.0}).value(), 0.0);
  EXPECT_FALSE(order_towards(1.0, {1.0, 1.0}, {2.0, 4.0}));
  EXPECT_FALSE(order_towards(4.0, {1.0, 1.0}, {2.0, 4.0}));
}

TEST(convergence, finds_order_and_limit_of_three_meshes) {
  for (const double order : {0.5, 1.0, 2.0}) {
    const auto result = [&](double factor) { return MeshResult{factor, 7.0 - 2.0 * std::pow(factor, -order)}; };
    const auto found = extrapolate({result(1.0), result(3.0), result(9.0)});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->order, order, 1e-12);
    EXPECT_NEAR(found->limit, 7.0, 1e-12);
  }
}

TEST(convergence, finds_no_limit_where_results_swing_spread_or_stay) {
  EXPECT_FALSE(extrapolate({MeshResult{1.0, 1.0}, {2.0, 3.0}, {4.0, 2.0}}));
  EXPECT_FALSE(extrapolate({MeshResult{1.0, 1.0}, {2.0, 2.0}, {4.0, 4.0}}));
  EXPECT_FALSE(extrapolate({MeshResult{1.0, 1.0}, {2.0, 1.0}, {4.0, 1.0}}));
  EXPECT_FALSE(extrapolate({MeshResult{1.0, 1.0}, {2.0, 2.0}, {4.0, 2.0}}));
}

TEST(convergence, finds_no_order_of_meshes_that_are_not_refined_evenly) {
  const auto result = [](double factor) { return MeshResult{factor, 7.0 - 2.0 / factor}; };
  EXPECT_TRUE(extrapolate({result(0.8), result(1.0), result(1.25)}));
  EXPECT_FALSE(extrapolate({result(0.75), result(1.0), result(1.25)}));
  EXPECT_TRUE(refined_evenly(0.25, 0.5, 1.0));
  EXPECT_FALSE(refined_evenly(0.5, 1.0, 4.0));
}

}  // namespace
}  // namespace fexp::io
