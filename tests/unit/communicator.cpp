// SPDX-License-Identifier: Apache-2.0
#include "cluster/communicator.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/thread_world.hpp"

namespace fexp::cluster {
namespace {

using namespace std::chrono_literals;

Bytes bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return {bytes.begin(), bytes.end()};
}

std::string text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Work on `count` ranks, each behind `latency`.
void on_ranks(int count, std::chrono::duration<double> latency, const std::function<void(Communicator&)>& work) {
  const auto network = std::make_shared<test::ThreadNetwork>(count);
  std::vector<std::thread> ranks;
  for (int r = 0; r < count; ++r) {
    ranks.emplace_back([&, r] {
      SlowCommunicator slow(std::make_unique<test::ThreadCommunicator>(network, r), latency);
      work(slow);
    });
  }
  for (std::thread& rank : ranks) {
    rank.join();
  }
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(communicator, alone_gathers_its_own_bytes_and_sends_nothing) {
  LoneCommunicator lone;
  EXPECT_EQ(lone.size(), 1);
  const std::vector<Bytes> all = lone.all_gather(bytes_of("alone"));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(text_of(all[0]), "alone");
  EXPECT_TRUE(lone.exchange({}, {}).empty());
  EXPECT_EQ(lone.traffic().messages, 0);
  EXPECT_EQ(lone.traffic().bytes, 0);
}

TEST(communicator, gathers_parts_of_any_size_in_the_order_of_ranks) {
  on_ranks(3, 0s, [](Communicator& world) {
    const std::vector<std::string> said{"", "one", "two and more"};
    const std::vector<Bytes> all = world.all_gather(bytes_of(said[static_cast<std::size_t>(world.rank())]));
    ASSERT_EQ(all.size(), 3U);
    for (std::size_t r = 0; r < said.size(); ++r) {
      EXPECT_EQ(text_of(all[r]), said[r]);
    }
  });
}

TEST(communicator, counts_a_message_to_each_other_rank_and_its_bytes) {
  on_ranks(3, 0s, [](Communicator& world) {
    const std::vector<std::size_t> sizes{5, 5, 5};
    static_cast<void>(world.all_gather(bytes_of("12345"), sizes));
    EXPECT_EQ(world.traffic().messages, 2);
    EXPECT_EQ(world.traffic().bytes, 10);
    std::vector<Parcel> parcels;
    std::vector<int> sources;
    if (world.rank() == 0) {
      parcels.push_back({2, bytes_of("abc")});
    } else if (world.rank() == 2) {
      sources.push_back(0);
    }
    const std::vector<Parcel> come = world.exchange(parcels, sources);
    EXPECT_EQ(come.size(), sources.size());
    EXPECT_EQ(world.traffic().messages, world.rank() == 0 ? 3 : 2);
    EXPECT_EQ(world.traffic().bytes, world.rank() == 0 ? 13 : 10);
    if (!come.empty()) {
      EXPECT_EQ(come[0].rank, 0);
      EXPECT_EQ(text_of(come[0].bytes), "abc");
    }
  });
}

TEST(slow_communicator, makes_a_gathering_wait_once_for_each_doubling_of_the_ranks) {
  // 5 ranks: 3 rounds.
  for (const auto& [count, rounds] : {std::pair{2, 1}, {4, 2}, {5, 3}}) {
    const double seconds = seconds_of([count = count] {
      on_ranks(count, 30ms, [](Communicator& world) {
        const std::vector<std::size_t> sizes(static_cast<std::size_t>(world.size()), 1);
        EXPECT_EQ(world.all_gather(bytes_of("x"), sizes).size(), sizes.size());
        EXPECT_GT(world.traffic().seconds, 0.029);
      });
    });
    EXPECT_GE(seconds, 0.030 * rounds);
    EXPECT_LT(seconds, 0.030 * (rounds + 1) + 1.0);  // room for a busy machine
  }
}

TEST(slow_communicator, waits_in_an_exchange_only_where_something_is_sent_or_comes) {
  on_ranks(3, 30ms, [](Communicator& world) {
    std::vector<Parcel> parcels;
    std::vector<int> sources;
    if (world.rank() == 0) {
      parcels.push_back({1, bytes_of("abc")});
    } else if (world.rank() == 1) {
      sources.push_back(0);
    }
    const std::vector<Parcel> come = world.exchange(parcels, sources);
    EXPECT_EQ(come.size(), sources.size());
    if (world.rank() < 2) {
      EXPECT_GE(world.traffic().seconds, 0.030);
    } else {
      EXPECT_LT(world.traffic().seconds, 0.030);
    }
  });
}

TEST(slow_communicator, of_one_rank_does_not_wait) {
  SlowCommunicator slow(std::make_unique<LoneCommunicator>(), 60s);
  EXPECT_EQ(text_of(slow.all_gather(bytes_of("alone")).front()), "alone");
  EXPECT_LT(slow.traffic().seconds, 60.0);
}

}  // namespace
}  // namespace fexp::cluster
