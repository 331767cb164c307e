// SPDX-License-Identifier: Apache-2.0
#include "io/expectation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fexp::io {
namespace {

/// Two nodes of a set at times 0, 1, 3, and one of another set.
const CsvTable nodes{{"step", "time [ms]", "set", "body", "node", "displacement_x [mm]"},
                     {{"0", "0", "tip", "b", "7", "1"},
                      {"0", "0", "tip", "b", "9", "3"},
                      {"0", "0", "root", "b", "1", "50"},
                      {"5", "1", "tip", "b", "7", "-8"},
                      {"5", "1", "tip", "b", "9", "-4"},
                      {"5", "1", "root", "b", "1", "60"},
                      {"9", "3", "tip", "b", "7", "2"},
                      {"9", "3", "tip", "b", "9", "6"},
                      {"9", "3", "root", "b", "1", "70"}}};

Expectation of_tip(const std::string& over_rows, const std::string& over_time) {
  Expectation e;
  e.name = "x";
  e.column = "displacement_x";
  e.set = "tip";
  e.over_rows = over_rows;
  e.over_time = over_time;
  e.reference = 4.0;
  return e;
}

double number(const Expectation& e) {
  ErrorList errors;
  const double found = expected_number(e, nodes, errors);
  EXPECT_TRUE(errors.empty());
  return found;
}

TEST(expectation, gathers_rows_of_a_moment) {
  EXPECT_EQ(number(of_tip("mean", "last")), 4.0);
  EXPECT_EQ(number(of_tip("sum", "last")), 8.0);
  EXPECT_EQ(number(of_tip("smallest", "last")), 2.0);
  EXPECT_EQ(number(of_tip("largest", "last")), 6.0);
}

TEST(expectation, takes_one_number_from_a_course) {
  EXPECT_EQ(number(of_tip("mean", "first")), 2.0);
  EXPECT_EQ(number(of_tip("mean", "smallest")), -6.0);
  EXPECT_EQ(number(of_tip("mean", "largest")), 4.0);
  EXPECT_EQ(number(of_tip("mean", "farthest")), -6.0);
  EXPECT_EQ(number(of_tip("mean", "mean")), 0.0);
  Expectation late = of_tip("mean", "farthest");
  late.from = 2.0;
  EXPECT_EQ(number(late), 4.0);
}

TEST(expectation, interpolates_in_time_and_stays_within) {
  Expectation e = of_tip("mean", "at");
  for (const auto& [time, value] : {std::pair{0.0, 2.0}, {0.5, -2.0}, {1.0, -6.0}, {2.0, -1.0}, {3.0, 4.0}}) {
    e.time = time;
    EXPECT_EQ(number(e), value) << time;
  }
  for (const double time : {-1.0, 3.1}) {
    e.time = time;
    ErrorList errors;
    EXPECT_TRUE(std::isnan(expected_number(e, nodes, errors)));
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors.errors()[0].text().find("0 to 3"), std::string::npos);
  }
}

TEST(expectation, chooses_rows_by_set_body_and_node) {
  Expectation e = of_tip("mean", "last");
  e.node = 9;
  EXPECT_EQ(number(e), 6.0);
  e.set = "";
  e.node = Expectation::any_node;
  EXPECT_EQ(number(e), 26.0);
  e.body = "c";
  ErrorList errors;
  EXPECT_TRUE(std::isnan(expected_number(e, nodes, errors)));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(expectation, names_a_column_that_is_not_there_and_those_that_are) {
  Expectation e = of_tip("mean", "last");
  e.column = "displacement";
  ErrorList errors;
  EXPECT_TRUE(std::isnan(expected_number(e, nodes, errors)));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors.errors()[0].text().find("step, time, set, body, node, displacement_x"), std::string::npos);
}

TEST(expectation, selects_by_columns_that_the_history_has) {
  const CsvTable energies{{"step", "time", "kinetic"}, {{"0", "0", "1"}}};
  ErrorList errors;
  EXPECT_TRUE(std::isnan(expected_number(of_tip("mean", "last"), energies, errors)));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(expectation, has_a_relative_error_unless_nothing_is_expected) {
  Expectation e;
  e.reference = -4.0;
  EXPECT_EQ(error_of(e, -5.0), 0.25);
  e.reference = 0.0;
  EXPECT_EQ(error_of(e, -5.0), 5.0);
  EXPECT_TRUE(std::isnan(error_of(e, std::nan(""))));
}

}  // namespace
}  // namespace fexp::io
