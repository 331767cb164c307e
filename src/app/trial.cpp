// SPDX-License-Identifier: Apache-2.0
#include "app/trial.hpp"

#include <sys/resource.h>

#include <chrono>

#include "app/schedule.hpp"

namespace fexp::app {

namespace {

double largest_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

Trial run_trial(const Case& loaded, double seconds) {
  const io::OutputSettings& intervals = loaded.deck.output;
  const double duration = loaded.model.run.duration;
  Schedule schedule(duration, intervals.results_interval, intervals.history_interval);
  cluster::Simulation simulation(loaded.model, solve::KernelChoice::automatic);
  Trial trial;
  for (Index b = 0; b < loaded.model.body_count(); ++b) {
    const model::BodyLedger& ledger = simulation.state().ledger[at(b)];
    if (ledger.contact_energy > 0.0) {
      trial.touching.push_back(b);
    }
  }
  const auto start = std::chrono::steady_clock::now();
  while (!schedule.over() && trial.seconds < seconds && trial.last.fault.kind == cluster::FaultKind::none) {
    trial.last = simulation.run_epoch(schedule.next());
    if (simulation.state().time == schedule.next()) {
      schedule.advance();
    }
    trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  trial.steps = simulation.state().step;
  trial.time = simulation.state().time;
  trial.memory_bytes = largest_memory();
  if (trial.time > 0.0) {
    const auto steps = static_cast<double>(trial.steps);
    trial.expected_steps = steps * (duration / trial.time);
    trial.expected_seconds = trial.seconds * (duration / trial.time);
    trial.element_steps_per_second = steps * static_cast<double>(loaded.model.element_count()) / trial.seconds;
  }
  return trial;
}

}  // namespace fexp::app
