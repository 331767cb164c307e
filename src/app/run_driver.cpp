// SPDX-License-Identifier: Apache-2.0
#include "app/run_driver.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "app/fault_report.hpp"
#include "app/keeper.hpp"
#include "app/penetrations.hpp"
#include "app/placement_report.hpp"
#include "app/print.hpp"
#include "app/progress.hpp"
#include "app/run_output.hpp"
#include "app/run_summary.hpp"
#include "app/schedule.hpp"
#include "app/signals.hpp"
#include "base/stopwatch.hpp"
#include "io/checkpoint_files.hpp"
#include "io/output_error.hpp"
#include "io/summary.hpp"
#include "parallel/parallel.hpp"
#include "quality/assess.hpp"

namespace fexp::app {

namespace {

void note_output_error(const io::OutputError& error, RunEnd& end) {
  end.reason = EndReason::output_error;
  end.message = error.what();
}

/// Says on stderr why a run was not completed, and what to do.
ExitCode report_end(const RunEnd& end, std::int64_t frames, const io::RunDirectory& directory,
                    const std::string& history) {
  const std::string results = directory.results().string();
  const char* const state =
      end.fault.kind == cluster::FaultKind::not_finite ? "The last sound state" : "The state in which it stopped";
  std::error_code error;
  const std::string around = std::filesystem::exists(directory.fault(), error)
                                 ? fmt::format("; what is around the fault, at the start of its epoch too, is in {}",
                                               directory.fault().string())
                                 : "";
  switch (end.reason) {
    case EndReason::completed:
    case EndReason::reform:
      return ExitCode::done;
    case EndReason::fault:
      print_error(fmt::format("fexp: the run stopped: {}; cure: {}\n{}{} is the last frame of {}{}.\n",
                              end.fault.message, end.fault.cure, history, state, results, around));
      return ExitCode::fault;
    case EndReason::interrupted:
      print_error(
          fmt::format("fexp: {}; all files are closed, and {} can be read up to there.\nTo go on: fexp resume {}\n",
                      end.message, results, directory.path().string()));
      return static_cast<ExitCode>(128 + end.signal);
    case EndReason::output_error:
      print_error(
          fmt::format("fexp: {}\nThe run stopped; {} frames can be read from {}.\n", end.message, frames, results));
      return ExitCode::output;
  }
  return ExitCode::internal;
}

/// The files of rank 0: new ones, or those that a run goes on in. `failure`: why there are none.
void open_output(const Drive& run, const cluster::Simulation& simulation, std::optional<RunOutput>& output,
                 std::optional<std::string>& failure) {
  const Case& loaded = run.loaded;
  if (!run.ranks.is_first()) {
    return;
  }
  try {
    if (run.before_output) {
      run.before_output(simulation.state().step);
    }
    if (run.taken_up) {
      output.emplace(run.directory, loaded, run.taken_up->mark);
      output->log_resumed(simulation.state());
    } else {
      run.directory.write_versions(io::present_versions(simulation.workspace().kernel.name));
      const Schedule schedule(loaded.model.run.duration, loaded.deck.output.results_interval,
                              loaded.deck.output.history_interval);
      output.emplace(run.directory, loaded, schedule.frames(), run.settings.hash_every > 0);
    }
    output->log(fmt::format("fexp {} runs: {} elements, {} nodes, {} bodies, {} ranks, {} threads, {} kernel",
                            FEXP_VERSION, loaded.model.element_count(), loaded.model.node_count(),
                            loaded.model.body_count(), run.ranks.size(), parallel::thread_count(),
                            simulation.workspace().kernel.name));
    for (const quality::Finding& finding : quality::far_tied_nodes(loaded.model)) {
      output->log("warning: " + finding.message);
    }
    for (const std::string& line : penetration_lines(loaded.penetrations)) {
      output->log(line);
    }
  } catch (const io::OutputError& error) {
    output.reset();
    failure = error.what();
  }
}

void close_output(std::optional<RunOutput>& output, RunEnd& end) {
  try {
    if (output) {
      output->close();
    }
  } catch (const io::OutputError& error) {
    // The first error counts.
    if (end.reason != EndReason::output_error) {
      note_output_error(error, end);
    }
  }
}

/// Writes the summary, and says on stdout and stderr what the user is to know. On rank 0.
ExitCode report(const Drive& run, const cluster::Simulation& simulation, const Keeper& keeper, std::int64_t frames,
                Clock::time_point start, RunEnd& end) {
  const Case& loaded = run.loaded;
  io::Summary summary;
  const auto finish_summary = [&] {
    summary = summarise(loaded, simulation, end);
    summary.ranks = run.ranks.size();
    summary.frames = frames;
    summary.files = files_of(run.directory);
    summary.wall_seconds = seconds_since(start);
    summary.network.snapshot_share =
        (keeper.memory_clock().total_seconds() + keeper.disk_clock().total_seconds()) / summary.wall_seconds;
  };
  finish_summary();
  try {
    write_placement(run.directory, summary, loaded.deck.units);
    finish_summary();
    io::write_summary(run.directory.summary(), summary);
  } catch (const io::OutputError& error) {
    if (end.reason != EndReason::output_error) {
      note_output_error(error, end);
      finish_summary();
    }
  }
  if (run.settings.json) {
    print_json(io::to_json(summary));
  } else if (run.link != nullptr || !run.settings.quiet) {
    const std::string text = summary_text(summary, loaded.deck.units, simulation.start(), end.last.diagnostics);
    if (run.link != nullptr) {
      run.link->send({{"event", "summary"}, {"text", text}});
    } else {
      print_out(text);
    }
  }
  return report_end(end, frames, run.directory, history_text(loaded.model, end.fault, loaded.deck.units));
}

}  // namespace

void clear_saved(const Drive& run, const RunEnd& end) {
  if (end.reason != EndReason::completed && end.reason != EndReason::fault) {
    return;
  }
  if (run.ranks.is_first()) {
    io::CheckpointFiles(run.directory.checkpoints()).clear();
  }
  if (run.snapshots != nullptr) {
    run.snapshots->clear();
  }
}

ExitCode drive(const Drive& run, RunEnd& end) {
  const auto start = Clock::now();
  const Case& loaded = run.loaded;
  cluster::World world = run.ranks.join(run.settings.world);
  std::optional<cluster::Simulation> simulation;
  if (run.taken_up) {
    simulation.emplace(loaded.model, run.settings.kernel, std::move(world), run.taken_up->pieces);
  } else {
    simulation.emplace(loaded.model, run.settings.kernel, std::move(world));
  }
  Keeper keeper({run.directory.checkpoints(), run.settings.checkpoint_seconds, run.settings.hash_every});
  if (run.link != nullptr) {
    keeper.serve(*run.link, *run.snapshots);
    run.link->began_at(simulation->state().step);
    run.link->send({{"event", "started"}, {"step", simulation->state().step}, {"time", simulation->state().time}});
  }
  std::optional<std::string> failure;
  std::optional<RunOutput> output;
  open_output(run, *simulation, output, failure);
  {
    Progress progress(run.ranks.is_first() && !run.settings.quiet, loaded.model.run.duration,
                      loaded.deck.units.of("time"));
    run_time_loop({loaded, run.settings.hash_every, *simulation, output ? &*output : nullptr, progress, keeper,
                   run.taken_up.has_value(), failure},
                  end);
  }
  if (output) {
    output->log(end.reason == EndReason::completed ? "completed" : end.message);
  }
  close_output(output, end);
  ExitCode code = ExitCode::done;
  if (run.ranks.is_first() && end.reason != EndReason::reform) {
    code = report(run, *simulation, keeper, output ? output->frames() : 0, start, end);
  }
  // Only rank 0 knows whether the files are complete.
  const auto reason = static_cast<std::byte>(end.reason);
  end.reason = static_cast<EndReason>(run.ranks.from_first(std::span(&reason, 1)).front());
  if (run.link == nullptr) {
    clear_saved(run, end);
  }
  return code;
}

}  // namespace fexp::app
