// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace fexp::app {

/// Writes items on a thread of its own, in the order in which they are handed over, while their producer goes on. There
/// are two items, filled again and again, so that one can be filled while the other is written. What writing throws
/// reaches the producer once, and nothing is written after it. One thread at a time may be the producer.
template <class Item>
class BackgroundWriter {
 public:
  /// `write` is called on the thread.
  explicit BackgroundWriter(std::function<void(Item&)> write)
      : write_(std::move(write)), thread_([this] { write_all(); }) {}
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;
  /// Writes first what has been handed over.
  ~BackgroundWriter() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  /// The item to fill next, with what it held before. Waits while both are to be written.
  [[nodiscard]] Item& next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return handed_over_ - done_ < items_.size(); });
    rethrow();
    if (handed_over_ == done_) {
      // The first one again: while the thread keeps up, the second one needs no memory.
      handed_over_ = done_ = 0;
    }
    return items_[handed_over_ % items_.size()];
  }
  /// Has the item that next() gave written.
  void hand_over() {
    {
      const std::lock_guard lock(mutex_);
      ++handed_over_;
    }
    changed_.notify_all();
  }

  /// Waits until all is written that has been handed over; what failed is thrown by the next call.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return handed_over_ == done_; });
  }
  /// Throws what writing has thrown by now.
  void check() {
    const std::lock_guard lock(mutex_);
    rethrow();
  }
  /// Waits until all is written.
  void drain() {
    wait();
    check();
  }

 private:
  void rethrow() {
    if (error_) {
      std::rethrow_exception(std::exchange(error_, nullptr));
    }
  }

  void write_all() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return ending_ || handed_over_ > done_; });
      if (handed_over_ == done_) {
        return;
      }
      if (!failed_) {
        Item& item = items_[done_ % items_.size()];
        lock.unlock();
        std::exception_ptr error;
        try {
          write_(item);
        } catch (...) {
          error = std::current_exception();
        }
        lock.lock();
        failed_ = error != nullptr;
        error_ = std::move(error);
      }
      ++done_;
      changed_.notify_all();
    }
  }

  std::function<void(Item&)> write_;
  std::array<Item, 2> items_{};
  std::mutex mutex_;
  std::condition_variable changed_;
  // Numbers of items. Those from done_ to handed_over_ are the thread's, the others the producer's.
  std::size_t handed_over_{};
  std::size_t done_{};
  bool ending_{};
  bool failed_{};
  std::exception_ptr error_;
  std::thread thread_;  // Last: it uses all of the above.
};

}  // namespace fexp::app
