// SPDX-License-Identifier: Apache-2.0
#include "base/elementary.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace fexp {
namespace {

double relative_error(double value, long double exact) {
  return static_cast<double>(std::abs((static_cast<long double>(value) - exact) / exact));
}

constexpr double largest_error = 2e-12;

TEST(elementary, logarithm_follows_the_c_library) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> decade(-307.0, 308.0), near_one(0.5, 1.5);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    for (const double x : {std::pow(10.0, decade(random)), near_one(random)}) {
      worst = std::max(worst, relative_error(binary_log(x), std::log2(static_cast<long double>(x))));
    }
  }
  EXPECT_LT(worst, largest_error);
  EXPECT_EQ(binary_log(1.0), 0.0);
  EXPECT_EQ(binary_log(1024.0), 10.0);
}

TEST(elementary, exponential_follows_the_c_library) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> argument(-1000.0, 1000.0);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = argument(random);
    worst = std::max(worst, relative_error(binary_exponential(x), std::exp2(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, largest_error);
  EXPECT_EQ(binary_exponential(0.0), 1.0);
  EXPECT_EQ(binary_exponential(-7.0), 1.0 / 128.0);
}

TEST(elementary, power_follows_the_c_library) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> decade(-12.0, 1.0), exponent(-1.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double x = std::pow(10.0, decade(random)), n = exponent(random);
    worst = std::max(worst,
                     relative_error(power(x, n), std::pow(static_cast<long double>(x), static_cast<long double>(n))));
  }
  EXPECT_LT(worst, largest_error);
}

TEST(elementary, power_of_one_is_one) {
  EXPECT_EQ(power(1.0, 0.3), 1.0);
  EXPECT_EQ(power(0.25, 1.0), 0.25);
  EXPECT_EQ(power(4.0, -0.5), 0.5);
}

TEST(elementary, packs_of_every_width_give_the_bits_of_doubles) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> decade(-290.0, 290.0);
  const auto compare = [&]<int W>(std::integral_constant<int, W>) {
    for (int i = 0; i < 2000; ++i) {
      std::array<double, static_cast<std::size_t>(W)> x{};
      Pack<W> packed;
      for (int lane = 0; lane < W; ++lane) {
        x[static_cast<std::size_t>(lane)] = std::pow(10.0, decade(random));
        packed.set_lane(lane, x[static_cast<std::size_t>(lane)]);
      }
      const Pack<W> log = binary_log(packed), exp = binary_exponential(log), pow = power(packed, 0.37);
      for (int lane = 0; lane < W; ++lane) {
        const double one = x[static_cast<std::size_t>(lane)];
        ASSERT_EQ(std::bit_cast<std::uint64_t>(log.lane(lane)), std::bit_cast<std::uint64_t>(binary_log(one)));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(exp.lane(lane)),
                  std::bit_cast<std::uint64_t>(binary_exponential(binary_log(one))));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(pow.lane(lane)), std::bit_cast<std::uint64_t>(power(one, 0.37)));
      }
    }
  };
  compare(std::integral_constant<int, 2>{});
  compare(std::integral_constant<int, 4>{});
  compare(std::integral_constant<int, 8>{});
}

}  // namespace
}  // namespace fexp
