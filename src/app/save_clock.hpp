// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace fexp::app {

/// When it is time to save again: so seldom that saving costs a fiftieth of the run at most, and not more often than
/// asked for.
class SaveClock {
 public:
  explicit SaveClock(double least_seconds) : least_(least_seconds) {}

  [[nodiscard]] bool due() const {
    return std::chrono::duration<double>(Clock::now() - last_).count() >= std::max(least_, times_of_cost * cost_);
  }
  /// It has been saved, which took so long [s].
  void saved(double seconds) {
    last_ = Clock::now();
    // One slow time, of a disk that was busy, is soon forgotten.
    cost_ = count_++ == 0 ? seconds : 0.5 * (cost_ + seconds);
    total_ += seconds;
  }
  [[nodiscard]] double total_seconds() const noexcept { return total_; }
  [[nodiscard]] int count() const noexcept { return count_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double times_of_cost = 50.0;
  double least_;
  double cost_{};
  double total_{};
  int count_{};
  Clock::time_point last_{Clock::now()};
};

}  // namespace fexp::app
