// SPDX-License-Identifier: Apache-2.0
#include "app/background_writer.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <semaphore>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace fexp::app {
namespace {

using namespace std::chrono_literals;

/// Long enough for a thread that does not wait as it should to be caught at it.
constexpr auto a_while = 30ms;

void hand_over(BackgroundWriter<int>& writer, int number) {
  writer.next() = number;
  writer.hand_over();
}

std::vector<int> numbers_up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(background_writer, writes_all_in_order) {
  std::vector<int> written;
  BackgroundWriter<int> writer([&](int& number) { written.push_back(number); });
  for (int i = 0; i < 5000; ++i) {
    hand_over(writer, i);
  }
  writer.drain();
  EXPECT_EQ(written, numbers_up_to(5000));
}

TEST(background_writer, waits_when_both_items_are_busy_and_only_then) {
  std::atomic<int> handed_over{}, written{};
  std::counting_semaphore<> allowed(0);
  std::vector<int> numbers;
  BackgroundWriter<int> writer([&](int& number) {
    allowed.acquire();
    numbers.push_back(number);
    ++written;
  });
  std::thread producer([&] {
    for (int i = 0; i < 6; ++i) {
      hand_over(writer, i);
      ++handed_over;
    }
  });
  for (int done = 0; done <= 4; ++done) {
    while (handed_over < done + 2) {
      std::this_thread::sleep_for(1ms);
    }
    std::this_thread::sleep_for(a_while);
    EXPECT_EQ(handed_over, done + 2);
    EXPECT_EQ(written, done);
    allowed.release();
  }
  allowed.release(1);
  producer.join();
  writer.drain();
  EXPECT_EQ(numbers, numbers_up_to(6));
}

TEST(background_writer, uses_one_item_again_while_the_thread_keeps_up) {
  std::counting_semaphore<> allowed(0);
  BackgroundWriter<int> writer([&](int&) { allowed.acquire(); });
  const int* first = &writer.next();
  writer.hand_over();
  const int* second = &writer.next();
  EXPECT_NE(first, second) << "the first one is being written";
  writer.hand_over();
  allowed.release(2);
  writer.drain();
  allowed.release(10);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(&writer.next(), first);
    writer.hand_over();
    writer.drain();
  }
}

TEST(background_writer, gives_items_back_with_what_they_held) {
  BackgroundWriter<std::vector<int>> writer([](std::vector<int>&) {});
  writer.next().assign(1000, 1);
  writer.hand_over();
  writer.drain();
  EXPECT_EQ(writer.next().size(), 1000U) << "its memory is to be used again";
}

TEST(background_writer, throws_once_what_writing_threw_and_writes_nothing_after_it) {
  for (const std::string where : {"next", "check", "drain"}) {
    SCOPED_TRACE(where);
    std::vector<int> written;
    std::counting_semaphore<> allowed(0);
    BackgroundWriter<int> writer([&](int& number) {
      allowed.acquire();
      if (number == 2) {
        throw std::runtime_error("full");
      }
      written.push_back(number);
    });
    allowed.release(2);
    for (int i = 0; i < 4; ++i) {
      hand_over(writer, i);
    }
    writer.check();
    allowed.release(100);
    if (where != "drain") {
      writer.wait();
    }
    try {
      if (where == "next") {
        static_cast<void>(writer.next());
      } else if (where == "check") {
        writer.check();
      } else {
        writer.drain();
      }
      ADD_FAILURE() << "did not throw";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::string("full"));
    }
    writer.check();
    for (int i = 4; i < 10; ++i) {
      hand_over(writer, i);
    }
    writer.drain();
    EXPECT_EQ(written, numbers_up_to(2));
  }
}

TEST(background_writer, has_all_written_after_draining) {
  std::atomic<int> written{};
  BackgroundWriter<int> writer([&](int&) {
    std::this_thread::sleep_for(a_while);
    ++written;
  });
  writer.drain();
  for (int expected = 2; expected <= 6; expected += 2) {
    hand_over(writer, 0);
    hand_over(writer, 0);
    writer.drain();
    EXPECT_EQ(written, expected);
  }
}

TEST(background_writer, writes_at_its_end_what_has_been_handed_over) {
  for (int count = 0; count <= 2; ++count) {
    std::vector<int> written;
    {
      BackgroundWriter<int> writer([&](int& number) {
        std::this_thread::sleep_for(a_while);
        written.push_back(number);
      });
      for (int i = 0; i < count; ++i) {
        hand_over(writer, i);
      }
    }
    EXPECT_EQ(written, numbers_up_to(count));
  }
}

TEST(background_writer, ends_with_an_error_that_nobody_asked_for) {
  BackgroundWriter<int> writer([](int&) { throw std::runtime_error("full"); });
  hand_over(writer, 0);
  hand_over(writer, 1);
}

}  // namespace
}  // namespace fexp::app
