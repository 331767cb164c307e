// SPDX-License-Identifier: Apache-2.0
#include "app/schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace fexp::app {
namespace {

struct Moments {
  std::vector<double> all;
  std::vector<double> frames;
  std::vector<double> rows;
};

Moments moments_of(Schedule schedule) {
  Moments moments;
  for (; !schedule.over(); schedule.advance()) {
    moments.all.push_back(schedule.next());
    if (schedule.frame_due()) {
      moments.frames.push_back(schedule.next());
    }
    if (schedule.row_due()) {
      moments.rows.push_back(schedule.next());
    }
  }
  return moments;
}

/// Every multiple below the end once, and the end.
void expect_multiples(const std::vector<double>& found, double interval, double duration, double tolerance) {
  const auto below = static_cast<std::size_t>(std::ceil(duration / interval - 1.0e-6)) - 1;
  ASSERT_EQ(found.size(), below + 1) << "every " << interval << " until " << duration;
  for (std::size_t k = 0; k < below; ++k) {
    ASSERT_NEAR(found[k], static_cast<double>(k + 1) * interval, tolerance);
  }
  EXPECT_EQ(found.back(), duration);
}

TEST(schedule, meets_every_multiple_of_any_two_intervals_once_and_the_end) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> logarithm(-4.0, 0.5);
  for (int trial = 0; trial < 300; ++trial) {
    const double duration = std::pow(10.0, 3.0 * logarithm(random));
    const double results = duration * std::pow(10.0, logarithm(random));
    // Now and then one interval is a whole multiple of the other, but for rounding.
    const double history =
        trial % 3 == 0 ? results / (1 + static_cast<int>(random() % 30)) : duration * std::pow(10.0, logarithm(random));
    const Schedule schedule(duration, results, history);
    const Moments moments = moments_of(schedule);
    const double tolerance = 1.0e-6 * std::min(results, history);
    expect_multiples(moments.frames, results, duration, 0.0);
    expect_multiples(moments.rows, history, duration, tolerance);
    EXPECT_EQ(schedule.frames(), static_cast<std::int64_t>(moments.frames.size()) + 1);
    for (std::size_t i = 1; i < moments.all.size(); ++i) {
      ASSERT_GT(moments.all[i] - moments.all[i - 1], 0.5 * tolerance) << "a step as short as a rounding error";
    }
  }
}

/// The moments from the first after `time` on.
Moments moments_after(Schedule schedule, double time) {
  schedule.skip_to(time);
  return moments_of(schedule);
}

TEST(schedule, taken_up_at_any_time_goes_on_with_the_moments_that_are_left) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const double duration = std::pow(10.0, 4.0 * part(random) - 2.0);
    const double results = duration * (trial % 4 == 0 ? 0.1 : 0.01 + part(random));
    const double history =
        trial % 3 == 0 ? results / (1 + static_cast<int>(random() % 30)) : duration * part(random) + 0.001 * duration;
    Schedule schedule(duration, results, history);
    const Moments all = moments_after(schedule, 0.0);
    ASSERT_EQ(all.all, moments_of(schedule).all);
    for (double before = 0.0; !schedule.over(); before = schedule.next(), schedule.advance()) {
      // At the moment that was written last, between it and the next, and close to the next.
      for (const double time : {before, before + part(random) * 0.99 * (schedule.next() - before)}) {
        const Moments left = moments_after(schedule, time);
        const Moments expected = moments_of(schedule);
        ASSERT_EQ(left.all, expected.all) << time << " of " << duration << ", " << results << ", " << history;
        ASSERT_EQ(left.frames, expected.frames);
        ASSERT_EQ(left.rows, expected.rows);
      }
    }
    EXPECT_TRUE(moments_after(schedule, duration).all.empty());
  }
}

TEST(schedule, moments_that_differ_by_rounding_are_one) {
  // 3 x 0.1 is above 0.3, and 7 x 0.3 above 2.1.
  const Moments moments = moments_of(Schedule(2.1, 0.3, 0.1));
  EXPECT_EQ(moments.all.size(), 21U);
  EXPECT_EQ(moments.frames.size(), 7U);
}

TEST(schedule, an_interval_longer_than_the_run_leaves_start_and_end) {
  const Schedule schedule(1.0, 5.0, 7.0);
  EXPECT_EQ(moments_of(schedule).all, std::vector<double>{1.0});
  EXPECT_EQ(schedule.frames(), 2);
}

TEST(schedule, intervals_left_out_are_parts_of_the_duration) {
  io::Deck deck;
  deck.description.run.duration = 10.0;
  fill_intervals(1.0e-3, deck);
  EXPECT_EQ(deck.output.results_interval, 0.2);
  EXPECT_EQ(deck.output.history_interval, 0.02);
}

TEST(schedule, intervals_left_out_leave_ten_steps_between_moments_of_a_short_run) {
  io::Deck deck;
  deck.description.run.duration = 10.0;
  fill_intervals(0.1, deck);  // 100 steps
  EXPECT_EQ(deck.output.results_interval, 1.0);
  EXPECT_EQ(deck.output.history_interval, 1.0);
  deck.output.history_interval = 0.5;
  deck.output.results_interval = -1.0;
  fill_intervals(3.0, deck);  // less than ten steps
  EXPECT_EQ(deck.output.results_interval, 10.0);
  EXPECT_EQ(deck.output.history_interval, 0.5);
}

TEST(schedule, an_interval_that_would_give_endless_output_is_an_error) {
  io::Deck deck;
  deck.description.run.duration = 10.0;
  deck.output.results_interval = 1.0e-9;
  deck.output.place = {"deck.toml", 7, 1};
  ErrorList errors;
  check_intervals(deck, errors);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors.errors()[0].text(),
            "deck.toml:7:1: error: output.results_interval = 1e-09 would be written 1e+10 times; accepted: >= "
            "run.duration / 1e+07 = 1e-06; cure: give a longer interval");
}

}  // namespace
}  // namespace fexp::app
