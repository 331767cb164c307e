// SPDX-License-Identifier: Apache-2.0
#include "base/trigonometry.hpp"

#include <gtest/gtest.h>

namespace fexp {
namespace {

// At these angles glibc 2.36 gives one value on processors with fused multiply-add and another one without. Expected
// are the exact values, computed with 200 bits, rounded to double.
TEST(trigonometry, rounds_the_exact_value_where_processors_differ) {
  EXPECT_EQ(sine(0x1.acee9f37bebd5p-1), 0x1.7c7d7a833bec1p-1);
  EXPECT_EQ(sine(0x1.4bc08f251d867p+2), -0x1.c83201d3d2c6dp-1);
  EXPECT_EQ(cosine(0x1.10f97ec96ec28p+2), -0x1.bac90250b5a6dp-2);
  EXPECT_EQ(cosine(0x1.c34df21cb97e7p+0), -0x1.87077cd217db9p-3);
  EXPECT_EQ(tangent(0x1.e08bddedb902ep-6), 0x1.e0af27cdffe84p-6);
}

}  // namespace
}  // namespace fexp
