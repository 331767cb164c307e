// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/errors.hpp"
#include "io/deck.hpp"

namespace fexp::app {

/// Reports output intervals that would ask for more rows than any use.
void check_intervals(const io::Deck& deck, ErrorList& errors);

/// Fills in output intervals that the deck leaves out: parts of the duration, but of a short run no more than every few
/// steps, because output shortens them. `step` is the largest stable step [time].
void fill_intervals(double step, io::Deck& deck);

/// The moments of output: multiples of both intervals and the end. Multiples are counted, not added up, so none is
/// missed or doubled by rounding, and moments that differ by rounding only are one.
class Schedule {
 public:
  Schedule(double duration, double results_interval, double history_interval);

  [[nodiscard]] bool over() const noexcept { return over_; }
  /// The next moment of output [time].
  [[nodiscard]] double next() const noexcept { return next_; }
  [[nodiscard]] bool frame_due() const noexcept { return frame_due_; }
  [[nodiscard]] bool row_due() const noexcept { return row_due_; }
  /// Goes on to the moment after.
  void advance();
  /// Goes on, or back, to the first moment after `time`; a moment at `time`, but for rounding, is over.
  void skip_to(double time);

  /// Frames of a whole run, the first and the last included.
  [[nodiscard]] std::int64_t frames() const noexcept;

 private:
  struct Series {
    double interval{};
    std::int64_t number{1};
    [[nodiscard]] double time() const noexcept { return static_cast<double>(number) * interval; }
  };
  void find_next();

  double duration_;
  double same_;  ///< Moments closer than this are one [time]
  Series results_;
  Series rows_;
  double next_{};
  bool frame_due_{};
  bool row_due_{};
  bool over_{};
};

}  // namespace fexp::app
