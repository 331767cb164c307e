// SPDX-License-Identifier: Apache-2.0
#include "app/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fexp::app {

namespace {

/// Part of the shorter interval within which two moments are one: far above the rounding of the largest multiple, far
/// below anything that a user can mean.
constexpr double same_part = 1.0e-6;
constexpr double most_multiples = 1.0e7;
/// Steps between moments of output that the deck leaves to the program: then they cost a tenth of the steps at most.
constexpr double least_steps = 10.0;

}  // namespace

void check_intervals(const io::Deck& deck, ErrorList& errors) {
  const double duration = deck.description.run.duration;
  const auto check = [&](const char* name, double interval) {
    if (interval > 0.0 && !(duration / interval <= most_multiples)) {
      errors.add(deck.output.place,
                 fmt::format("output.{} = {} would be written {:.3g} times", name, interval, duration / interval),
                 fmt::format(">= run.duration / {:.0e} = {}", most_multiples, duration / most_multiples),
                 "give a longer interval");
    }
  };
  check("results_interval", deck.output.results_interval);
  check("history_interval", deck.output.history_interval);
}

void fill_intervals(double step, io::Deck& deck) {
  const double duration = deck.description.run.duration;
  const double most_parts = std::max(1.0, std::floor(duration / (least_steps * step)));
  const auto fill = [&](double& interval, double usual_parts) {
    interval = interval > 0.0 ? interval : duration / std::min(usual_parts, most_parts);
  };
  fill(deck.output.results_interval, 50.0);
  fill(deck.output.history_interval, 500.0);
}

Schedule::Schedule(double duration, double results_interval, double history_interval)
    : duration_(duration),
      same_(same_part * std::min({duration, results_interval, history_interval})),
      results_{results_interval},
      rows_{history_interval} {
  find_next();
}

void Schedule::find_next() {
  next_ = std::min(results_.time(), rows_.time());
  if (next_ > duration_ - same_) {
    next_ = duration_;
    frame_due_ = row_due_ = true;
    return;
  }
  frame_due_ = results_.time() < next_ + same_;
  row_due_ = rows_.time() < next_ + same_;
  // Of moments that are one, the frame's counts.
  next_ = frame_due_ ? results_.time() : next_;
}

void Schedule::advance() {
  over_ = over_ || next_ >= duration_;
  results_.number += frame_due_ ? 1 : 0;
  rows_.number += row_due_ ? 1 : 0;
  find_next();
}

void Schedule::skip_to(double time) {
  for (Series* series : {&results_, &rows_}) {
    // The quotient is rounded, so the search begins below it.
    series->number = std::max<std::int64_t>(1, static_cast<std::int64_t>(time / series->interval) - 1);
    while (series->time() < time + same_) {
      ++series->number;
    }
  }
  over_ = time >= duration_;
  find_next();
}

std::int64_t Schedule::frames() const noexcept {
  // Multiples below the end, the start and the end.
  return static_cast<std::int64_t>(std::ceil((duration_ - same_) / results_.interval)) + 1;
}

}  // namespace fexp::app
