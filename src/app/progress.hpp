// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "cluster/simulation.hpp"

namespace fexp::app {

/// How far a run is, on stderr: one refreshed line on a terminal, otherwise a line now and then.
class Progress {
 public:
  /// `shown` false: prints nothing.
  Progress(bool shown, double duration, std::string time_unit);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Leaves no half line behind.
  ~Progress() { clear(); }

  /// After an epoch; prints when enough time or simulated time has passed since it last did.
  void show(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  /// Removes the refreshed line, before anything else is printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] bool is_time(Clock::time_point now, double part) const;
  [[nodiscard]] std::string text(const cluster::Simulation& simulation, const cluster::EpochReport& report,
                                 double seconds) const;

  bool shown_;
  bool terminal_;
  double duration_;
  std::string time_unit_;
  Clock::time_point start_{Clock::now()};
  Clock::time_point last_{start_};
  double last_part_{};
  bool on_line_{};
};

/// "1:02:03", "4:05" or "0.6 s".
[[nodiscard]] std::string wall_time_text(double seconds);

/// "4.2 million element-steps/s" and the like.
[[nodiscard]] std::string rate_text(double element_steps_per_second);

}  // namespace fexp::app
