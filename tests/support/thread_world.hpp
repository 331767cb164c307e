// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <barrier>
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"

/// Worlds of several ranks inside one process: a thread for each rank, memory for a network.
namespace fexp::test {

class ThreadNetwork {
 public:
  explicit ThreadNetwork(int size) : size_(size), slots_(static_cast<std::size_t>(size)), barrier_(size) {}

  [[nodiscard]] int size() const noexcept { return size_; }

  Bytes all_gather(int rank, std::span<const std::byte> own) {
    slots_[static_cast<std::size_t>(rank)].assign(own.begin(), own.end());
    barrier_.arrive_and_wait();
    Bytes all;
    for (const Bytes& slot : slots_) {
      all.insert(all.end(), slot.begin(), slot.end());
    }
    barrier_.arrive_and_wait();
    return all;
  }

  void send(int from, int to, Bytes bytes) {
    const std::lock_guard lock(mutex_);
    letters_[{from, to}].push_back(std::move(bytes));
    come_.notify_all();
  }

  Bytes receive(int from, int to) {
    std::unique_lock lock(mutex_);
    std::vector<Bytes>& letters = letters_[{from, to}];
    come_.wait(lock, [&] { return !letters.empty(); });
    Bytes bytes = std::move(letters.front());
    letters.erase(letters.begin());
    return bytes;
  }

 private:
  int size_;
  std::vector<Bytes> slots_;
  std::barrier<> barrier_;
  std::mutex mutex_;
  std::condition_variable come_;
  std::map<std::pair<int, int>, std::vector<Bytes>> letters_;
};

class ThreadCommunicator final : public cluster::Communicator {
 public:
  ThreadCommunicator(std::shared_ptr<ThreadNetwork> network, int rank) : network_(std::move(network)), rank_(rank) {}
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return network_->size(); }

 protected:
  Bytes do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> /*sizes*/) override {
    return network_->all_gather(rank_, own);
  }
  std::vector<cluster::Parcel> do_exchange(const std::vector<cluster::Parcel>& parcels,
                                           std::span<const int> sources) override {
    for (const cluster::Parcel& parcel : parcels) {
      network_->send(rank_, parcel.rank, parcel.bytes);
    }
    std::vector<cluster::Parcel> come;
    for (const int source : sources) {
      come.push_back({source, network_->receive(source, rank_)});
    }
    return come;
  }

 private:
  std::shared_ptr<ThreadNetwork> network_;
  int rank_;
};

/// Machines named as given, one rank each.
inline std::vector<cluster::Machine> machines(const std::vector<std::string>& names) {
  std::vector<cluster::Machine> list;
  for (const std::string& name : names) {
    cluster::Machine machine;
    machine.name = name;
    machine.rank = static_cast<int>(list.size());
    list.push_back(machine);
  }
  return list;
}

/// Runs work(world) on a thread for each machine, with `threads` threads of its own, and rethrows what one throws. A
/// rank that throws leaves the others waiting, so only all of them may.
template <class Work>
void with_world(const std::vector<std::string>& names, const Work& work, int threads = 1,
                cluster::PlacementRule rule = cluster::PlacementRule::fewest_elements) {
  const auto network = std::make_shared<ThreadNetwork>(static_cast<int>(names.size()));
  std::vector<std::exception_ptr> thrown(names.size());
  std::vector<std::thread> ranks;
  for (std::size_t r = 0; r < names.size(); ++r) {
    ranks.emplace_back([&, r] {
      try {
        cluster::World world;
        world.communicator = std::make_shared<ThreadCommunicator>(network, static_cast<int>(r));
        world.machines = machines(names);
        world.rule = rule;
        tbb::task_arena arena(threads);
        arena.execute([&] { work(std::move(world)); });
      } catch (...) {
        thrown[r] = std::current_exception();
      }
    });
  }
  for (std::thread& rank : ranks) {
    rank.join();
  }
  for (const std::exception_ptr& error : thrown) {
    if (error) {
      std::rethrow_exception(error);
    }
  }
}

}  // namespace fexp::test
