// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/command.hpp"
#include "app/load.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/progress.hpp"
#include "app/run_output.hpp"
#include "app/run_summary.hpp"
#include "app/schedule.hpp"
#include "app/signals.hpp"
#include "app/time_loop.hpp"
#include "cluster/simulation.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

using Clock = std::chrono::steady_clock;

struct RunOptions {
  std::string deck;
  std::string out;
  bool force{};
  int threads{};
  bool quiet{};
  bool json{};
  std::int64_t hash_every{};
  solve::KernelChoice kernel{solve::KernelChoice::automatic};
};

void note_output_error(const io::OutputError& error, RunEnd& end) {
  end.reason = EndReason::output_error;
  end.message = error.what();
}

/// Runs the loop with its files; an output error becomes the run's end.
std::int64_t run_with_output(const RunOptions& options, const Case& loaded, const io::RunDirectory& directory,
                             cluster::Simulation& simulation, RunEnd& end) {
  std::optional<RunOutput> output;
  Progress progress(!options.quiet, loaded.model.run.duration, loaded.deck.units.of("time"));
  try {
    directory.write_versions(io::present_versions(simulation.workspace().kernel.name));
    const Schedule schedule(loaded.model.run.duration, loaded.deck.output.results_interval,
                            loaded.deck.output.history_interval);
    output.emplace(directory, loaded, schedule.frames(), options.hash_every > 0);
    output->log(fmt::format("fexp {} runs {}: {} elements, {} nodes, {} bodies, {} threads, {} kernel", FEXP_VERSION,
                            options.deck, loaded.model.element_count(), loaded.model.node_count(),
                            loaded.model.body_count(), parallel::thread_count(), simulation.workspace().kernel.name));
    run_time_loop(loaded, options.hash_every, simulation, *output, progress, end);
    output->log(end.reason == EndReason::completed ? "completed" : end.message);
  } catch (const io::OutputError& error) {
    note_output_error(error, end);
  }
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
  return output ? output->frames() : 0;
}

/// Says on stderr why a run was not completed, and what to do.
ExitCode report_end(const RunEnd& end, std::int64_t frames, const io::RunDirectory& directory) {
  const std::string results = directory.results().string();
  switch (end.reason) {
    case EndReason::completed:
      return ExitCode::done;
    case EndReason::fault:
      print_error(fmt::format("fexp: the run stopped: {}; cure: {}\nThe last sound state is the last frame of {}.\n",
                              end.fault.message, end.fault.cure, results));
      return ExitCode::fault;
    case EndReason::interrupted:
      print_error(fmt::format(
          "fexp: {}; all files are closed, and {} can be read up to there.\nTo go on, run the deck again: it "
          "begins at the start, in a new directory unless --out and --force say otherwise.\n",
          end.message, results));
      return static_cast<ExitCode>(128 + end.signal);
    case EndReason::output_error:
      print_error(
          fmt::format("fexp: {}\nThe run stopped; {} frames can be read from {}.\n", end.message, frames, results));
      return ExitCode::output;
  }
  return ExitCode::internal;
}

ExitCode run_here(const RunOptions& options) {
  const auto start = Clock::now();
  const Case loaded = load_case(options.deck);
  const SignalWatch watch;
  cluster::Simulation simulation(loaded.model, options.kernel);
  const auto directory = io::RunDirectory::create(options.deck, loaded.deck_bytes, options.out, options.force);
  RunEnd end;
  const std::int64_t frames = run_with_output(options, loaded, directory, simulation, end);
  io::Summary summary;
  const auto finish_summary = [&] {
    summary = summarise(loaded, simulation, end);
    summary.frames = frames;
    summary.files = files_of(directory);
    summary.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  };
  finish_summary();
  try {
    io::write_summary(directory.summary(), summary);
  } catch (const io::OutputError& error) {
    if (end.reason != EndReason::output_error) {
      note_output_error(error, end);
      finish_summary();
    }
  }
  if (options.json) {
    print_json(io::to_json(summary));
  } else if (!options.quiet) {
    print_out(summary_text(summary, loaded.deck.units, simulation.start(), end.last.diagnostics));
  }
  return report_end(end, frames, directory);
}

ExitCode run(const RunOptions& options) {
  if (solve::select_element_kernel(options.kernel).function == nullptr) {
    print_error("fexp: --kernel: this processor cannot run the kernel asked for; cure: leave --kernel out\n");
    return ExitCode::wrong_input;
  }
  ExitCode code = ExitCode::internal;
  parallel::with_threads(options.threads, [&] { code = run_here(options); });
  return code;
}

std::function<ExitCode()> declare(CLI::App& app) {
  using solve::KernelChoice;
  auto options = std::make_shared<RunOptions>();
  add_deck_option(app, options->deck);
  app.add_option("--out", options->out, "Directory for the results; DECK.run, DECK-2.run ... when left out")
      ->option_text("DIR");
  app.add_flag("--force", options->force, "Replace the results in the directory");
  add_threads_option(app, options->threads);
  app.add_flag("--quiet", options->quiet, "Print errors only");
  add_json_option(app, options->json, "Print the summary as JSON, and nothing else, on the standard output");
  app.add_option("--hash-every", options->hash_every,
                 "Write a hash of every body after every N steps, for \"fexp compare\"")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62))
      ->option_text("N");
  const std::map<std::string, KernelChoice> kernels{{"auto", KernelChoice::automatic},
                                                    {"scalar", KernelChoice::scalar},
                                                    {"baseline", KernelChoice::baseline},
                                                    {"avx2", KernelChoice::avx2},
                                                    {"avx512", KernelChoice::avx512}};
  app.add_option("--kernel", options->kernel,
                 "Element kernel: auto, scalar, baseline, avx2 or avx512; all give the same bits (for tests)")
      ->transform(CLI::CheckedTransformer(kernels))
      ->option_text("NAME");
  return [options] { return run(*options); };
}

}  // namespace

const Command run_command{"run", "Integrate a deck and write its results",
                          "  fexp run four_spheres.toml              results in four_spheres.run\n"
                          "  fexp run plate.toml --out /data/plate --force --threads 8\n"
                          "  fexp run plate.toml --json > plate.json",
                          declare};

}  // namespace fexp::app
