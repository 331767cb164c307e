// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/run_driver.hpp"
#include "app/saved_run.hpp"
#include "app/signals.hpp"
#include "app/take_ups.hpp"
#include "app/with_ranks.hpp"
#include "base/errors.hpp"
#include "coordinator/record.hpp"
#include "io/checkpoint_files.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

struct ResumeOptions {
  std::string run;
  int threads{};
  DriveSettings drive;
};

/// Refuses what is no run or has nothing to go on with.
void check_run(const io::RunDirectory& directory) {
  ErrorList errors;
  std::error_code error;
  const std::string name = directory.path().string();
  if (!fs::is_directory(directory.path(), error)) {
    errors.add({name}, "there is no such directory", "the directory of a run", "check the path");
  } else if (!fs::exists(directory.inputs(), error)) {
    errors.add({name}, "it has no inputs.fexp, so it is no run of this program", "the directory of a run",
               "check the path");
  } else if (io::is_completed(directory.summary())) {
    errors.add({name}, "the run is complete", "a run that was interrupted", "nothing is left to be done");
  }
  errors.throw_if_any();
}

struct Found {
  io::InputFiles files;
  SavedRun saved;
};

Found find(const io::RunDirectory& directory) {
  check_run(directory);
  Found found{io::InputFiles::packed_in(directory.inputs()), {}};
  const io::FoundCheckpoint checkpoint = io::CheckpointFiles(directory.checkpoints()).newest();
  for (const std::string& sentence : checkpoint.passed_over) {
    print_error("fexp: " + sentence + "\n");
  }
  found.saved = SavedRun::from(checkpoint.sections, checkpoint.path);
  return found;
}

ExitCode resume_here(const ResumeOptions& options, Ranks& ranks) {
  const io::RunDirectory directory(options.run);
  Found found;
  TakeUps take_ups;
  std::optional<coordinator::RunLock> lock;
  ranks.on_first([&] {
    if (fs::exists(directory.path() / "cluster.lock")) {
      lock.emplace(directory.path());
    }
    found = find(directory);
    take_ups = TakeUps::read(directory.taken_up());
  });
  const SignalWatch watch;
  const Case loaded = ranks.load(found.files.deck(), found.files);
  TakenUp taken_up;
  DriveSettings settings = options.drive;
  if (ranks.is_first()) {
    taken_up.pieces.push_back(std::move(found.saved.piece));
    taken_up.mark = found.saved.mark;
    settings.hash_every = found.saved.hash_every;
  }
  const Bytes hash_every = ranks.from_first(std::as_bytes(std::span<const std::int64_t>(&settings.hash_every, 1)));
  settings.hash_every = ByteReader(hash_every).value<std::int64_t>();
  if (ranks.is_first() && !settings.quiet) {
    print_error(fmt::format("fexp: going on from step {}, time {:.6g}\n", found.saved.step, found.saved.time));
  }
  RunEnd end;
  Drive run{ranks, loaded, directory, settings, std::move(taken_up)};
  if (take_ups.count() > 0) {
    // Snapshots of the cluster run that this was speak of files that are cut back now.
    run.before_output = [&](std::int64_t step) {
      take_ups.add(step);
      take_ups.write(directory.taken_up());
    };
  }
  return drive(run, end);
}

std::function<ExitCode()> declare_resume(CLI::App& app) {
  auto options = std::make_shared<ResumeOptions>();
  app.add_option("RUN", options->run, "Directory of a run that was interrupted or killed")->required();
  add_threads_option(app, options->threads);
  app.add_flag("--quiet", options->drive.quiet, "Print errors only");
  add_json_option(app, options->drive.json, "Print the summary as JSON, and nothing else, on the standard output");
  add_drive_options(app, options->drive);
  return [options] { return with_ranks(options->threads, [&](Ranks& ranks) { return resume_here(*options, ranks); }); };
}

}  // namespace

const Command resume_command{"resume", "Go on with a run from its last checkpoint",
                             "  fexp resume four_spheres.run            from the last checkpoint there\n"
                             "  fexp resume plate.run --threads 16      with other threads; the results are the same\n"
                             "  mpirun -n 4 fexp resume swarm.run       on other machines",
                             declare_resume};

}  // namespace fexp::app
