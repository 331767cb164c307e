// SPDX-License-Identifier: Apache-2.0
#include "app/time_loop.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <vector>

#include "app/balance_text.hpp"
#include "app/schedule.hpp"
#include "app/signals.hpp"
#include "base/stopwatch.hpp"
#include "io/output_error.hpp"

namespace fexp::app {

namespace {

class Loop {
 public:
  Loop(const LoopParts& parts, RunEnd& end)
      : parts_(parts),
        end_(end),
        output_(parts.output),
        schedule_(parts.loaded.model.run.duration, parts.loaded.deck.output.results_interval,
                  parts.loaded.deck.output.history_interval),
        row_bodies_(Histories::bodies_needed(parts.loaded)),
        failed_(parts.failure.has_value()),
        failure_(parts.failure.value_or("")) {}

  void run() {
    cluster::Simulation& simulation = parts_.simulation;
    end_.last = simulation.present();
    end_.first_step = simulation.state().step;
    if (parts_.resumed) {
      schedule_.skip_to(simulation.state().time);
    } else {
      write_row();
      write_frame();
    }
    bool going = true;
    while (going && !schedule_.over()) {
      going = run_epoch();
    }
    if (schedule_.over() && end_.reason == EndReason::completed && simulation.model().run.is_static() &&
        !simulation.relaxation().settled()) {
      note_unrest();
    }
    if (end_.reason != EndReason::reform) {
      write_row();
      write_frame();
    }
    write([&] { output_->drain(); });
    end_.last_step = simulation.state().step;
    if (failed_) {
      end_.reason = EndReason::output_error;
      end_.message = failure_;
    }
  }

 private:
  /// False when the run, or this world of it, ends.
  bool run_epoch() {
    cluster::Simulation& simulation = parts_.simulation;
    cluster::Requests requests = parts_.keeper.ask(simulation);
    requests.output_error = failed_;
    const auto start = Clock::now();
    end_.last = simulation.run_epoch(schedule_.next(), parts_.hash_every, requests);
    end_.stepping_seconds += seconds_since(start);
    // On all ranks, or they would pile up where nobody logs them.
    const std::vector<cluster::LedgerMove> moves = simulation.ledger().take_moves();
    write([&] {
      log_moves(moves);
      output_->epoch(end_.last);
    });
    if (end_.last.fault.kind != cluster::FaultKind::none) {
      end_.reason = EndReason::fault;
      end_.fault = end_.last.fault;
      end_.message = end_.fault.message;
      simulation.collect();
      simulation.collect_epoch_start();
      write([&] { output_->fault(simulation, end_.fault); });
      return false;
    }
    if (simulation.state().time == schedule_.next()) {
      // Rows first: they reach the disk with the frame.
      if (schedule_.row_due()) {
        write_row();
      }
      if (schedule_.frame_due()) {
        write_frame();
      }
      schedule_.advance();
    }
    if (simulation.rank() == 0) {
      parts_.progress.show(simulation, end_.last);
      tell_status();
    }
    return go_on();
  }

  /// A static analysis that has not come to rest has no answer.
  void note_unrest() {
    const cluster::Simulation& simulation = parts_.simulation;
    end_.reason = EndReason::fault;
    end_.fault.kind = cluster::FaultKind::not_settled;
    end_.fault.message = fmt::format("the static analysis has not settled: the residual is {:.2g} (run.residual {:g})",
                                     simulation.relaxation().residual(), simulation.model().run.residual);
    end_.fault.cure = "give run.duration more time, hold bodies that can move freely, or accept a larger run.residual";
    end_.message = end_.fault.message;
  }

  /// Does what was asked for; false when that ends the run.
  bool go_on() {
    cluster::Simulation& simulation = parts_.simulation;
    cluster::Requests asked = end_.last.requests;
    if (asked.output_error || (failed_ && simulation.world().communicator->size() == 1)) {
      end_.reason = EndReason::output_error;
      return false;
    }
    if (schedule_.over() || simulation.relaxation().settled()) {
      return false;
    }
    asked.reform = asked.reform || parts_.keeper.event_due(simulation);
    try {
      parts_.keeper.keep(simulation, asked, output_);
    } catch (const io::OutputError& error) {
      note_failure(error);
    }
    if (asked.stop) {
      end_.reason = EndReason::interrupted;
      end_.signal = SignalWatch::received();
      end_.message = fmt::format("interrupted at time {:.6g} of {:.6g}, step {}", simulation.state().time,
                                 simulation.model().run.duration, simulation.state().step);
      return false;
    }
    if (asked.reform) {
      end_.reason = EndReason::reform;
      return false;
    }
    return true;
  }

  void write_row() {
    parts_.simulation.collect(row_bodies_);
    write([&] { output_->row(parts_.simulation, end_.last); });
  }
  void write_frame() {
    parts_.simulation.collect();
    write([&] { output_->frame(parts_.simulation, end_.last); });
  }

  void log_moves(const std::vector<cluster::LedgerMove>& moves) {
    for (const cluster::LedgerMove& moved : moves) {
      const auto& machines = parts_.simulation.world().machines;
      const auto name = [&](cluster::MachineIndex m) { return machines[static_cast<std::size_t>(m)].name; };
      output_->log(fmt::format("step {}: body \"{}\" moves from {} to {}: {}", moved.step,
                               parts_.loaded.model.bodies[at(moved.move.body)].name, name(moved.move.from),
                               name(moved.move.to), cluster::text_of(moved.move.reason)));
    }
  }

  void tell_status();

  /// Output on rank 0, as long as the files can be written.
  void write(const std::function<void()>& work) {
    if (output_ == nullptr || failed_) {
      return;
    }
    try {
      work();
    } catch (const io::OutputError& error) {
      note_failure(error);
    }
  }
  void note_failure(const io::OutputError& error) {
    failed_ = true;
    failure_ = error.what();
    output_ = nullptr;
  }

  const LoopParts& parts_;
  RunEnd& end_;
  RunOutput* output_;
  Schedule schedule_;
  std::vector<Index> row_bodies_;
  bool failed_{};
  std::string failure_;
  std::chrono::steady_clock::time_point told_{};
};

void Loop::tell_status() {
  using namespace std::chrono_literals;
  WorkerLink* link = parts_.keeper.link();
  const auto now = std::chrono::steady_clock::now();
  if (link == nullptr || now - told_ < 100ms) {
    return;
  }
  told_ = now;
  const cluster::Simulation& simulation = parts_.simulation;
  const cluster::WorldLoad load = simulation.load();
  const double time = simulation.state().time, duration = simulation.model().run.duration;
  const auto done = static_cast<double>(simulation.state().step - end_.first_step);
  nlohmann::json machines = nlohmann::json::array();
  std::vector<std::int64_t> bodies(simulation.world().machines.size(), 0), elements(bodies);
  for (Index b = 0; b < simulation.model().body_count(); ++b) {
    if (const cluster::MachineIndex m = simulation.owner()[at(b)]; m != cluster::no_machine) {
      ++bodies[static_cast<std::size_t>(m)];
      elements[static_cast<std::size_t>(m)] += simulation.model().bodies[at(b)].elements.size();
    }
  }
  for (std::size_t m = 0; m < simulation.world().machines.size(); ++m) {
    const cluster::Machine& machine = simulation.world().machines[m];
    if (machine.present()) {
      machines.push_back({{"name", machine.name},
                          {"threads", machine.threads},
                          {"native_threads", machine.native_threads},
                          {"running_threads", load.running_threads[m]},
                          {"bodies", bodies[m]},
                          {"elements", elements[m]},
                          {"load", load.seconds > 0.0 ? load.busy_seconds[m] / load.seconds : 0.0}});
    }
  }
  link->send(
      {{"event", "status"},
       {"step", simulation.state().step},
       {"time", time},
       {"duration", duration},
       {"islands", end_.last.islands},
       {"contacts", end_.last.active_pairs},
       {"energy_error", end_.last.energy_error},
       {"machines", machines},
       {"moved_elements", simulation.ledger().moved_elements()},
       {"element_steps_per_second",
        load.seconds > 0.0 ? done * static_cast<double>(simulation.model().element_count()) / load.seconds : 0.0},
       {"seconds_left", done > 0.0 && time > 0.0 ? load.seconds / done * static_cast<double>(simulation.state().step) *
                                                       (duration - time) / time
                                                 : 0.0},
       {"balance", balance_text(load.balance)}});
}

}  // namespace

const char* name_of(EndReason reason) noexcept {
  switch (reason) {
    case EndReason::completed:
      return "completed";
    case EndReason::fault:
      return "fault";
    case EndReason::interrupted:
      return "interrupted";
    case EndReason::output_error:
      return "output error";
    case EndReason::reform:
      return "reform";
  }
  return "";
}

void run_time_loop(const LoopParts& parts, RunEnd& end) { Loop(parts, end).run(); }

}  // namespace fexp::app
