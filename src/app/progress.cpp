// SPDX-License-Identifier: Apache-2.0
#include "app/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/print.hpp"

namespace fexp::app {

namespace {

using namespace std::chrono_literals;

constexpr auto refresh_after = 100ms;  // on a terminal
constexpr auto line_after = 10s;       // elsewhere
constexpr auto no_line_before = 1s;
constexpr double line_after_part = 0.05;  // of the duration

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string wall_time_text(double seconds) {
  if (!(seconds < 1.0e9)) {
    return "unknown";
  }
  if (seconds < 60.0) {
    return fmt::format("{:.{}f} s", seconds, seconds < 9.95 ? 1 : 0);
  }
  const auto whole = static_cast<long>(std::lround(seconds));
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string rate_text(double element_steps_per_second) {
  return element_steps_per_second < 1.0e6
             ? fmt::format("{:.0f} element-steps/s", element_steps_per_second)
             : fmt::format("{:.1f} million element-steps/s", 1.0e-6 * element_steps_per_second);
}

Progress::Progress(bool shown, double duration, std::string time_unit)
    : shown_(shown), terminal_(isatty(STDERR_FILENO) == 1), duration_(duration), time_unit_(std::move(time_unit)) {}

bool Progress::is_time(Clock::time_point now, double part) const {
  const auto passed = now - last_;
  if (terminal_) {
    return passed >= refresh_after;
  }
  return passed >= line_after || (passed >= no_line_before && part >= last_part_ + line_after_part);
}

std::string Progress::text(const cluster::Simulation& simulation, const cluster::EpochReport& report,
                           double seconds) const {
  const model::State& state = simulation.state();
  const double part = state.time / duration_;
  const double rate =
      static_cast<double>(state.step) * static_cast<double>(simulation.model().element_count()) / seconds;
  return fmt::format(
      "{:5.1f} %  left {}  time {:.4g} of {:.4g} {}  step {}  dt {:.3g}  energy error {:.1e}  {} islands"
      "  {} contacts  {}",
      100.0 * part, wall_time_text(seconds * (1.0 - part) / part), state.time, duration_, time_unit_, state.step,
      report.dt, report.energy_error, report.islands, report.active_pairs, rate_text(rate));
}

void Progress::show(const cluster::Simulation& simulation, const cluster::EpochReport& report) {
  const Clock::time_point now = Clock::now();
  const double part = simulation.state().time / duration_;
  if (!shown_ || !is_time(now, part)) {
    return;
  }
  std::string line = text(simulation, report, std::chrono::duration<double>(now - start_).count());
  last_ = now;
  last_part_ = part;
  if (!terminal_) {
    print_error(line + "\n");
    return;
  }
  // A line as wide as the terminal would scroll it.
  line.resize(std::min(line.size(), terminal_columns() - 1));
  print_error(fmt::format("\r{}\x1b[K", line));
  on_line_ = true;
}

void Progress::clear() {
  if (on_line_) {
    print_error("\r\x1b[K");
    on_line_ = false;
  }
}

}  // namespace fexp::app
