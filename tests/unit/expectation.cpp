// SPDX-License-Identifier: Apache-2.0
#include "io/expectation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <span>
#include <vector>

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

TEST(expectation, takes_rows_between_two_times) {
  Expectation e = of_tip("mean", "farthest");
  e.until = 0.5;
  EXPECT_EQ(number(e), 2.0);
  e.until = 1.0;
  EXPECT_EQ(number(e), -6.0);
}

TEST(expectation, subtracts_other_rows_of_the_same_times) {
  Expectation e = of_tip("mean", "last");
  e.minus = Subtrahend{"", "root", "", std::nullopt, {}};
  EXPECT_EQ(number(e), 4.0 - 70.0);
  e.minus = Subtrahend{"", "", "", 7, {}};
  EXPECT_EQ(number(e), 4.0 - 2.0);
  e.minus = Subtrahend{"node", "", "", std::nullopt, {}};
  EXPECT_EQ(number(e), 4.0 - 8.0);
  e.minus = Subtrahend{"", "top", "", std::nullopt, {}};
  ErrorList errors;
  EXPECT_TRUE(std::isnan(expected_number(e, nodes, errors)));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(expectation, chooses_an_element_by_its_label) {
  const CsvTable elements{{"step", "time", "set", "body", "element", "thickness"},
                          {{"0", "0", "all", "b", "3", "1"}, {"0", "0", "all", "b", "4", "5"}}};
  Expectation e;
  e.column = "thickness";
  e.history = "elements";
  ErrorList errors;
  EXPECT_EQ(expected_number(e, elements, errors), 3.0);
  e.element = 4;
  EXPECT_EQ(expected_number(e, elements, errors), 5.0);
  e.minus = Subtrahend{"", "", "", std::nullopt, 3};
  EXPECT_EQ(expected_number(e, elements, errors), 4.0);
  EXPECT_TRUE(errors.empty());
  e.element = 5;
  EXPECT_TRUE(std::isnan(expected_number(e, elements, errors)));
  EXPECT_EQ(errors.size(), 1U);
}

TEST(expectation, divides_by_the_first_value_where_there_is_one) {
  Expectation e = of_tip("mean", "last");
  e.relative_to_first = true;
  EXPECT_EQ(number(e), 2.0);
  const CsvTable still{{"time", "kinetic"}, {{"0", "0"}, {"1", "3"}}};
  e.column = "kinetic";
  e.set = "";
  ErrorList errors;
  EXPECT_TRUE(std::isnan(expected_number(e, still, errors)));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors.errors()[0].text().find("first value is 0"), std::string::npos);
}

/// Passes 1 upwards at 0.5 and 4.5, downwards at 2.5.
const CsvTable wave{{"time", "x"},
                    {{"0", "0"}, {"1", "2"}, {"2", "2"}, {"3", "0"}, {"4", "0"}, {"5", "2"}, {"6", "-9"}}};

TEST(expectation, finds_crossings_periods_and_the_time_of_the_farthest) {
  Expectation e;
  e.name = e.column = "x";
  e.level = 1.0;
  ErrorList errors;
  e.over_time = "crossing";
  EXPECT_EQ(expected_number(e, wave, errors), 0.5);
  e.from = 1.0;
  EXPECT_EQ(expected_number(e, wave, errors), 2.5);
  e.from = 0.0;
  e.over_time = "period";
  EXPECT_EQ(expected_number(e, wave, errors), 4.0);
  e.over_time = "time_of_farthest";
  EXPECT_EQ(expected_number(e, wave, errors), 6.0);
  EXPECT_TRUE(errors.empty());
  e.over_time = "period";
  e.until = 4.0;  // One upward crossing is no period.
  EXPECT_TRUE(std::isnan(expected_number(e, wave, errors)));
  e.over_time = "crossing";
  e.level = 5.0;
  EXPECT_TRUE(std::isnan(expected_number(e, wave, errors)));
  EXPECT_EQ(errors.size(), 2U);
}

std::size_t errors_with(const std::vector<double>& meshes, const Expectation& e) {
  VerifySettings settings;
  settings.meshes = meshes;
  ErrorList errors;
  check_expectations(settings, std::span(&e, 1), errors);
  return errors.size();
}

TEST(expectation, meshes_ascend_and_hold_the_decks_own) {
  const Expectation e;
  for (const std::vector<double>& good : {std::vector<double>{}, {1.0, 2.0}, {0.5, 1.0}, {0.25, 0.5, 1.0}}) {
    EXPECT_EQ(errors_with(good, e), 0U);
  }
  for (const std::vector<double>& bad : {std::vector<double>{1.0}, {2.0, 1.0}, {1.0, 1.0, 2.0}, {0.5, 2.0}}) {
    EXPECT_EQ(errors_with(bad, e), 1U);
  }
}

TEST(expectation, is_for_meshes_that_are_run_and_an_order_needs_a_series) {
  Expectation e;
  e.mesh = 1.0;
  EXPECT_EQ(errors_with({}, e), 0U);
  EXPECT_TRUE(is_held(e, 1.0));
  EXPECT_FALSE(in_series(e));
  e.mesh = 2.0;
  EXPECT_EQ(errors_with({1.0, 2.0}, e), 0U);
  EXPECT_EQ(errors_with({1.0, 4.0}, e), 1U);
  EXPECT_FALSE(is_held(e, 1.0));
  e.least_order = 1.0;
  EXPECT_EQ(errors_with({1.0, 2.0}, e), 1U);
  e.mesh = -1.0;
  EXPECT_TRUE(is_held(e, 2.0));
  EXPECT_FALSE(is_held(e, 0.5));
  EXPECT_EQ(errors_with({}, e), 1U);
  EXPECT_EQ(errors_with({1.0, 2.0}, e), 1U);
  EXPECT_EQ(errors_with({1.0, 2.0, 4.0}, e), 0U);
  EXPECT_EQ(errors_with({1.0, 2.0, 3.0}, e), 1U);  // Two ratios
  e.exact = true;
  EXPECT_EQ(errors_with({1.0, 2.0}, e), 0U);
}

TEST(expectation, chooses_rows_by_set_body_and_node) {
  Expectation e = of_tip("mean", "last");
  e.node = 9;
  EXPECT_EQ(number(e), 6.0);
  e.set = "";
  e.node = Expectation::any;
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
