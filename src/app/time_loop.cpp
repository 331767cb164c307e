// SPDX-License-Identifier: Apache-2.0
#include "app/time_loop.hpp"

#include <fmt/format.h>

#include <chrono>

#include "app/schedule.hpp"
#include "app/signals.hpp"

namespace fexp::app {

namespace {

cluster::EpochReport timed_epoch(cluster::Simulation& simulation, double target, std::int64_t hash_every,
                                 double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  cluster::EpochReport report = simulation.run_epoch(target, hash_every);
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace

void run_time_loop(const Case& loaded, std::int64_t hash_every, cluster::Simulation& simulation, RunOutput& output,
                   Progress& progress, RunEnd& end) {
  const io::OutputSettings& intervals = loaded.deck.output;
  const double duration = loaded.model.run.duration;
  Schedule schedule(duration, intervals.results_interval, intervals.history_interval);
  end.last = simulation.present();
  output.row(simulation, end.last);
  output.frame(simulation, end.last);
  while (!schedule.over()) {
    end.last = timed_epoch(simulation, schedule.next(), hash_every, end.stepping_seconds);
    output.epoch(end.last);
    if (end.last.fault.kind != cluster::FaultKind::none) {
      end.reason = EndReason::fault;
      end.fault = end.last.fault;
      end.message = end.fault.message;
      break;
    }
    if (simulation.state().time == schedule.next()) {
      // Rows first: they reach the disk with the frame.
      if (schedule.row_due()) {
        output.row(simulation, end.last);
      }
      if (schedule.frame_due()) {
        output.frame(simulation, end.last);
      }
      schedule.advance();
    }
    progress.show(simulation, end.last);
    if (SignalWatch::received() != 0 && !schedule.over()) {
      end.reason = EndReason::interrupted;
      end.signal = SignalWatch::received();
      end.message = fmt::format("interrupted at time {:.6g} of {:.6g}, step {}", simulation.state().time, duration,
                                simulation.state().step);
      break;
    }
  }
  output.row(simulation, end.last);
  output.frame(simulation, end.last);
}

}  // namespace fexp::app
