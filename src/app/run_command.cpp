// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/ranks.hpp"
#include "app/run_driver.hpp"
#include "app/signals.hpp"
#include "app/with_ranks.hpp"
#include "io/atomic_file.hpp"
#include "io/input_files.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

namespace {

struct RunOptions {
  std::string deck;
  std::string out;
  bool force{};
  int threads{};
  DriveSettings drive;
};

/// Makes the run's directory and writes what a later resumption needs of its files.
io::RunDirectory make_directory(const RunOptions& options, const Case& loaded, const io::InputFiles& files) {
  auto directory = io::RunDirectory::create(options.deck, loaded.deck_bytes, options.out, options.force);
  io::write_durably(directory.inputs(), files.pack());
  return directory;
}

ExitCode run_here(const RunOptions& options, Ranks& ranks) {
  io::InputFiles files;
  const Case loaded = ranks.load(options.deck, files);
  const SignalWatch watch;
  io::RunDirectory directory("");
  ranks.on_first([&] { directory = make_directory(options, loaded, files); });
  RunEnd end;
  return drive({ranks, loaded, directory, options.drive}, end);
}

ExitCode run(const RunOptions& options) {
  if (solve::select_element_kernel(options.drive.kernel).elements == nullptr) {
    print_error("fexp: --kernel: this processor cannot run the kernel asked for; cure: leave --kernel out\n");
    return ExitCode::wrong_input;
  }
  return with_ranks(options.threads, [&](Ranks& ranks) { return run_here(options, ranks); });
}

std::function<ExitCode()> declare_run(CLI::App& app) {
  using solve::KernelChoice;
  auto options = std::make_shared<RunOptions>();
  add_deck_option(app, options->deck);
  app.add_option("--out", options->out, "Directory for the results; DECK.run, DECK-2.run ... when left out")
      ->option_text("DIR");
  app.add_flag("--force", options->force, "Replace the results in the directory");
  add_threads_option(app, options->threads);
  app.add_flag("--quiet", options->drive.quiet, "Print errors only");
  add_json_option(app, options->drive.json, "Print the summary as JSON, and nothing else, on the standard output");
  app.add_option("--hash-every", options->drive.hash_every,
                 "Write a hash of every body after every N steps, for \"fexp compare\"")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62))
      ->option_text("N");
  add_drive_options(app, options->drive);
  const std::map<std::string, KernelChoice> kernels{{"auto", KernelChoice::automatic},
                                                    {"scalar", KernelChoice::scalar},
                                                    {"baseline", KernelChoice::baseline},
                                                    {"avx2", KernelChoice::avx2},
                                                    {"avx512", KernelChoice::avx512}};
  add_choice(app, "--kernel", options->drive.kernel, kernels,
             "Element kernel: auto, scalar, baseline, avx2 or avx512; all give the same bits (for tests)")
      ->option_text("NAME");
  return [options] { return run(*options); };
}

}  // namespace

const Command run_command{"run", "Integrate a deck and write its results",
                          "  fexp run four_spheres.toml              results in four_spheres.run\n"
                          "  fexp run plate.toml --out /data/plate --force --threads 8\n"
                          "  fexp run plate.toml --json > plate.json\n"
                          "  mpirun -n 4 fexp run swarm.toml         four ranks, each with its share of the cores",
                          declare_run};

}  // namespace fexp::app
