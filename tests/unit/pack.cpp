// SPDX-License-Identifier: Apache-2.0
#include "base/pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace fexp {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

template <class P>
class Packs : public testing::Test {};
using Widths = testing::Types<Pack<2>, Pack<4>, Pack<8>>;
TYPED_TEST_SUITE(Packs, Widths);

TYPED_TEST(Packs, compute_every_lane_with_the_bits_of_scalar_arithmetic) {
  std::mt19937_64 random(2);
  // Any bit pattern: subnormals, infinities and signed zeros too. NaN has bits of its own and is left out.
  const auto number = [&random] {
    for (;;) {
      const auto value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
      if (value == value) {
        return value;
      }
    }
  };
  for (int i = 0; i < 20000; ++i) {
    std::array<double, TypeParam::width> a, b;
    std::generate(a.begin(), a.end(), number);
    std::generate(b.begin(), b.end(), number);
    const TypeParam p = TypeParam::load(a.data()), q = TypeParam::load(b.data());
    const TypeParam sum = p + q, difference = p - q, product = p * q, quotient = p / q, negative = -p;
    const TypeParam root = square_root(p * p), low = minimum(p, q), high = maximum(p, q);
    for (int lane = 0; lane < TypeParam::width; ++lane) {
      const double x = a[static_cast<std::size_t>(lane)], y = b[static_cast<std::size_t>(lane)];
      const auto same = [](double packed, double scalar) {
        return same_bits(packed, scalar) || (std::isnan(packed) && std::isnan(scalar));
      };
      EXPECT_TRUE(same(sum.lane(lane), x + y)) << x << " + " << y;
      EXPECT_TRUE(same(difference.lane(lane), x - y)) << x << " - " << y;
      EXPECT_TRUE(same(product.lane(lane), x * y)) << x << " * " << y;
      EXPECT_TRUE(same(quotient.lane(lane), x / y)) << x << " / " << y;
      EXPECT_TRUE(same(negative.lane(lane), -x)) << x;
      EXPECT_TRUE(same(root.lane(lane), square_root(x * x))) << x;
      EXPECT_TRUE(same(low.lane(lane), minimum(x, y))) << x << ", " << y;
      EXPECT_TRUE(same(high.lane(lane), maximum(x, y))) << x << ", " << y;
    }
  }
}

TYPED_TEST(Packs, store_what_they_loaded_and_change_one_lane_at_a_time) {
  std::array<double, TypeParam::width> values{-0.0, 0x1p-1070}, stored{};
  TypeParam p = TypeParam::load(values.data());
  p.store(stored.data());
  EXPECT_TRUE(std::equal(values.begin(), values.end(), stored.begin(), same_bits));
  p.set_lane(1, 3.0);
  EXPECT_TRUE(same_bits(p.lane(0), -0.0));
  EXPECT_EQ(p.lane(1), 3.0);
}

TYPED_TEST(Packs, take_rows_into_lanes_and_give_them_back_filled_up_with_zeros) {
  constexpr std::size_t count = 19, width = TypeParam::width, pieces = (count + width - 1) / width;
  std::array<std::array<double, count>, width> table{};
  std::array<const double*, width> rows{};
  for (std::size_t lane = 0; lane < width; ++lane) {
    rows[lane] = table[lane].data();
    for (std::size_t i = 0; i < count; ++i) {
      table[lane][i] = static_cast<double>(100 * lane + i);
    }
  }
  std::array<TypeParam, count> packs;
  load_rows(rows, packs);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      EXPECT_EQ(packs[i].lane(static_cast<int>(lane)), table[lane][i]) << i << ", lane " << lane;
    }
  }
  std::array<std::array<typename TypeParam::Native, width>, pieces> back;
  to_rows(packs, back);
  for (std::size_t i = 0; i < pieces * width; ++i) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      const double value = TypeParam(back[i / width][lane]).lane(static_cast<int>(i % width));
      EXPECT_EQ(value, i < count ? table[lane][i] : 0.0) << i << ", lane " << lane;
    }
  }
}

}  // namespace
}  // namespace fexp
