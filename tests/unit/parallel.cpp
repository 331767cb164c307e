// SPDX-License-Identifier: Apache-2.0
#include "parallel/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace {

using namespace fexp;

constexpr int most_threads = 8;

TEST(parallel, every_index_is_visited_once_whatever_count_grain_and_threads) {
  for (const int threads : {1, 2, 3, most_threads}) {
    parallel::with_threads(threads, [] {
      for (const Index grain : {1, 2, 7, 64}) {
        for (const Index count : {0, 1, 2, 6, 7, 8, 63, 64, 65, 128, 129, 1000}) {
          std::vector<std::atomic<int>> visits(at(count));
          parallel::for_each(count, grain, [&](Index i) { ++visits.at(at(i)); });
          for (const auto& number : visits) {
            ASSERT_EQ(number, 1) << "count " << count << " grain " << grain;
          }
        }
      }
    });
  }
}

TEST(parallel, ranges_are_whole_disjoint_and_no_longer_than_they_must_be) {
  for (const Index grain : {1, 5, 64}) {
    for (const Index count : {1, 4, 5, 6, 11, 63, 64, 65, 1000}) {
      std::mutex mutex;
      std::set<std::pair<Index, Index>> ranges;
      parallel::for_ranges(count, grain, [&](Index begin, Index end) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(ranges.emplace(begin, end).second);
      });
      Index next = 0;
      for (const auto& [begin, end] : ranges) {
        EXPECT_EQ(begin, next);
        EXPECT_LT(begin, end);
        next = end;
      }
      EXPECT_EQ(next, count);
      EXPECT_EQ(ranges.size() == 1, count <= grain) << "count " << count << " grain " << grain;
    }
  }
}

TEST(parallel, nothing_is_called_for_no_items) {
  bool called = false;
  for (const Index count : {0, -1}) {
    parallel::for_ranges(count, 1, [&](Index, Index) { called = true; });
  }
  EXPECT_FALSE(called);
  EXPECT_EQ(parallel::ordered_fold(
                {3, 3}, 4, 7.0, [](Index, Index) { return 1.0; }, std::plus<>()),
            7.0);
}

TEST(parallel, nested_loops_visit_every_pair_once) {
  parallel::with_threads(most_threads, [] {
    constexpr Index outer = 13, inner = 200;
    std::vector<std::atomic<int>> visits(outer * inner);
    parallel::for_each(outer, 1,
                       [&](Index i) { parallel::for_each(inner, 3, [&](Index j) { ++visits[at(i * inner + j)]; }); });
    for (const auto& number : visits) {
      ASSERT_EQ(number, 1);
    }
  });
}

/// Different threads that take part in a loop whose pieces wait until all of them have begun, or long enough
/// for a busy machine.
int threads_at_work(int threads) {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  std::atomic<int> begun{0};
  parallel::with_threads(threads, [&] {
    parallel::for_each(threads + 3, 1, [&](Index) {
      {
        const std::lock_guard lock(mutex);
        ids.insert(std::this_thread::get_id());
      }
      ++begun;
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      while (begun < threads && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      }
    });
  });
  return static_cast<int>(ids.size());
}

TEST(parallel, work_runs_on_exactly_as_many_threads_as_asked_for_even_beyond_the_cores) {
  for (int threads = 1; threads <= most_threads; ++threads) {
    EXPECT_EQ(threads_at_work(threads), threads);
    parallel::with_threads(threads, [&] { EXPECT_EQ(parallel::thread_count(), threads); });
  }
  parallel::with_threads(0, [] { EXPECT_GE(parallel::thread_count(), 1); });
}

TEST(parallel, what_a_loop_throws_reaches_the_caller) {
  EXPECT_THROW(parallel::for_each(100, 1,
                                  [](Index i) {
                                    if (i == 57) {
                                      throw std::runtime_error("57");
                                    }
                                  }),
               std::runtime_error);
}

/// Numbers of very different sizes, so that every order of adding them rounds differently.
std::vector<double> uneven_numbers(Index count) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0), exponent(-30.0, 30.0);
  std::vector<double> values(at(count));
  for (double& value : values) {
    value = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
  }
  return values;
}

TEST(parallel, sums_are_those_of_the_serial_formula_for_any_number_of_threads) {
  const std::vector<double> values = uneven_numbers(10007);
  for (const Index piece : {1, 64, 1000, 20000}) {
    for (const IndexRange range : {IndexRange{0, 10007}, IndexRange{5, 1029}, IndexRange{64, 128}}) {
      double expected = 0.0;
      for (Index begin = range.begin; begin < range.end; begin += piece) {
        double part = 0.0;
        for (Index i = begin; i < std::min(begin + piece, range.end); ++i) {
          part += values[at(i)];
        }
        expected += part;
      }
      for (int threads = 1; threads <= most_threads; ++threads) {
        parallel::with_threads(threads, [&] {
          const double sum = parallel::ordered_fold(
              range, piece, 0.0,
              [&](Index begin, Index end) {
                double part = 0.0;
                for (Index i = begin; i < end; ++i) {
                  part += values[at(i)];
                }
                return part;
              },
              std::plus<>());
          EXPECT_EQ(sum, expected) << threads << " threads, pieces of " << piece;
        });
      }
    }
  }
}

TEST(parallel, a_fold_combines_in_ascending_order) {
  parallel::with_threads(most_threads, [] {
    using List = std::vector<std::pair<Index, Index>>;
    const List list = parallel::ordered_fold(
        {10, 31}, 5, List{},
        [](Index begin, Index end) {
          return List{{begin, end}};
        },
        [](List a, const List& b) {
          a.insert(a.end(), b.begin(), b.end());
          return a;
        });
    EXPECT_EQ(list, (List{{10, 15}, {15, 20}, {20, 25}, {25, 30}, {30, 31}}));
  });
}

}  // namespace
