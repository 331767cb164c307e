// SPDX-License-Identifier: Apache-2.0
#include "app/keeper.hpp"

#include <fmt/format.h>

#include <exception>
#include <optional>

#include "app/saved_run.hpp"
#include "app/signals.hpp"
#include "base/stopwatch.hpp"
#include "io/output_error.hpp"

namespace fexp::app {

namespace {

std::vector<Index> all_bodies(const model::Model& model) {
  std::vector<Index> bodies;
  for (Index b = 0; b < model.body_count(); ++b) {
    if (!model.bodies[at(b)].barrier) {
      bodies.push_back(b);
    }
  }
  return bodies;
}

}  // namespace

void Keeper::serve(WorkerLink& link, MemorySnapshots& snapshots) {
  link_ = &link;
  snapshots_ = &snapshots;
}

cluster::Requests Keeper::ask(const cluster::Simulation& simulation) {
  cluster::Requests requests;
  requests.stop = SignalWatch::received() != 0;
  if (simulation.rank() == 0) {
    requests.checkpoint = disk_clock_.due();
    requests.snapshot = snapshots_ != nullptr && memory_clock_.due();
    if (link_ != nullptr) {
      link_->poll();
      requests.reform = link_->reform_wanted();
      requests.stop = requests.stop || link_->stop_wanted() || link_->lost();
    }
  }
  return requests;
}

bool Keeper::event_due(const cluster::Simulation& simulation) const {
  return link_ != nullptr && link_->event_due(simulation.state().step);
}

void Keeper::keep(cluster::Simulation& simulation, const cluster::Requests& asked, RunOutput* output) {
  const bool leaving = asked.reform || asked.stop;
  if (snapshots_ != nullptr && (asked.snapshot || leaving)) {
    save_in_memory(simulation, output);
  }
  if (asked.checkpoint || asked.stop) {
    save_on_disk(simulation, output);
  }
}

void Keeper::save_in_memory(cluster::Simulation& simulation, RunOutput* output) {
  const auto start = Clock::now();
  std::optional<OutputMark> mark;
  std::exception_ptr failed;
  try {
    if (output != nullptr) {
      mark = output->mark();
    }
  } catch (const io::OutputError&) {
    failed = std::current_exception();
  }
  // The other ranks take part in it whatever has become of the files.
  snapshots_->save(simulation, settings_.hash_every, mark);
  memory_clock_.saved(seconds_since(start));
  if (failed) {
    std::rethrow_exception(failed);
  }
}

void Keeper::save_on_disk(cluster::Simulation& simulation, RunOutput* output) {
  const auto start = Clock::now();
  simulation.collect();
  if (output != nullptr) {
    SavedRun saved;
    saved.step = simulation.state().step;
    saved.time = simulation.state().time;
    saved.parts = {"all"};
    saved.part = "all";
    saved.hash_every = settings_.hash_every;
    saved.mark = output->mark();
    saved.piece = simulation.piece(all_bodies(simulation.model()));
    output->sync();
    io::CheckpointFiles(settings_.checkpoints).write(saved.step, saved.sections());
    output->log(fmt::format("checkpoint at step {}", saved.step));
  }
  disk_clock_.saved(seconds_since(start));
}

}  // namespace fexp::app
