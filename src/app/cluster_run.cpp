// SPDX-License-Identifier: Apache-2.0
#include "app/cluster_run.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "app/load.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/signals.hpp"
#include "app/thread_table.hpp"
#include "base/errors.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/host_source.hpp"
#include "coordinator/mpirun_command.hpp"
#include "coordinator/places.hpp"
#include "coordinator/record.hpp"
#include "io/atomic_file.hpp"
#include "io/input_files.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;
using coordinator::ClusterRecord;
using coordinator::Machine;
using coordinator::Outcome;
using Clock = std::chrono::steady_clock;

/// Lines for the user, in RUN/cluster.log and on stderr.
class Voice {
 public:
  Voice(const fs::path& run, bool quiet) : log_(std::fopen((run / "cluster.log").c_str(), "ae")), quiet_(quiet) {}

  void note(const std::string& text) {
    if (log_) {
      // Failures are passed over: a full disk must not end a run that waits for it to have room again.
      const std::string line = fmt::format("{:%Y-%m-%d %H:%M:%S}  {}\n", fmt::localtime(std::time(nullptr)), text);
      static_cast<void>(std::fwrite(line.data(), 1, line.size(), log_.get()));
      static_cast<void>(std::fflush(log_.get()));
    }
  }

  void say(const std::string& text) {
    note(text);
    if (!quiet_) {
      print_error(fmt::format("fexp: {}\n", text));
    }
  }

  /// A line now and then.
  void progress(const nlohmann::json& status) {
    using namespace std::chrono_literals;
    if (!quiet_ && Clock::now() - last_ > 10s) {
      last_ = Clock::now();
      print_error(fmt::format("fexp: step {}, time {}\n", status.value("step", nlohmann::json()).dump(),
                              status.value("time", nlohmann::json()).dump()));
    }
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { static_cast<void>(std::fclose(file)); }
  };
  std::unique_ptr<std::FILE, Close> log_;
  bool quiet_;
  Clock::time_point last_{Clock::now()};
};

coordinator::StepEvent parse_event(const std::string& text, ErrorList& errors) {
  std::istringstream words(text);
  coordinator::StepEvent event;
  std::string verb, machine, rest;
  const bool read = static_cast<bool>(words >> event.step >> verb >> machine) && !(words >> rest);
  if (!read || event.step < 0 || (verb != "add" && verb != "remove")) {
    errors.add({}, fmt::format("--at: \"{}\" cannot be understood", text), "\"STEP add HOST\" or \"STEP remove HOST\"",
               "correct it");
    return event;
  }
  event.add = verb == "add";
  event.machine = coordinator::parse_machine(machine, {"--at", 0, 0}, errors);
  return event;
}

/// The machines to begin with.
std::vector<Machine> first_machines(const ClusterRunOptions& options, ErrorList& errors) {
  if (options.hosts.empty() && options.discover.empty()) {
    return {{coordinator::own_name(), "localhost", 0}};
  }
  const std::string place = options.hosts.empty() ? options.discover : options.hosts;
  std::string text;
  try {
    text = options.hosts.empty() ? coordinator::run_host_script(options.discover) : io::read_whole(options.hosts);
  } catch (const io::OutputError& error) {
    errors.add({place}, error.message(), "a list of machines as mpirun's hosts files have", "check the path");
    return {};
  }
  const std::size_t before = errors.size();
  std::vector<Machine> machines = coordinator::parse_machines(text, place, errors);
  if (machines.empty() && errors.size() == before) {
    errors.add({place}, "names no machine", "a line with a name for each machine", "add one");
  }
  return machines;
}

void check_mpirun(ErrorList& errors) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((fs::path(folder) / "mpirun").c_str(), X_OK) == 0) {
      return;
    }
  }
  errors.add({}, "mpirun is not found", "a program on the PATH", "install the package openmpi-bin on every machine");
}

/// This program; for tests another one takes the worker's part.
std::vector<std::string> own_program() { return {fs::read_symlink("/proc/self/exe").string()}; }
std::vector<std::string> worker_program() {
  const char* other = std::getenv("FEXP_WORKER");  // NOLINT(concurrency-mt-unsafe)
  return other != nullptr && *other != '\0' ? coordinator::split_words(other) : own_program();
}

std::string name_of(cluster::PlacementRule rule) {
  const auto& rules = placement_rules();
  return std::ranges::find(rules, rule, &std::pair<const std::string, cluster::PlacementRule>::second)->first;
}

std::string absolute(const std::string& path) { return path.empty() ? "" : fs::absolute(path).string(); }

ExitCode report(const coordinator::FinishRun& end, const io::RunDirectory& directory, bool json) {
  const std::string run = directory.path().string();
  const std::string again = fmt::format("\"fexp cluster resume {}\" goes on.", run);
  if (json && fs::exists(directory.summary())) {
    print_out(io::read_whole(directory.summary()));
  }
  switch (end.outcome) {
    case Outcome::completed:
      return ExitCode::done;
    case Outcome::fault:
      print_error(fmt::format("fexp: the run stopped: {}\nWhat came before it is in {}.\n", end.message, run));
      return ExitCode::fault;
    case Outcome::stopped:
      print_error(fmt::format("fexp: the run was ended. {}\n", again));
      return SignalWatch::received() != 0 ? static_cast<ExitCode>(128 + SignalWatch::received())
                                          : ExitCode::interrupted;
    case Outcome::gave_up:
      print_error(fmt::format("fexp: {}\nWhen that is cured, {}\n", end.message, again));
      return ExitCode::cluster;
  }
  return ExitCode::internal;
}

ExitCode coordinate(const io::RunDirectory& directory, const ClusterRecord& record, bool quiet, bool json) {
  const SignalWatch watch;
  Voice voice(directory.path(), quiet);
  coordinator::CoordinatorSettings settings;
  settings.run = directory.path();
  settings.record = record;
  settings.program = own_program();
  settings.worker = worker_program();
  settings.say = [&](const std::string& text) { voice.say(text); };
  settings.note = [&](const std::string& text) { voice.note(text); };
  settings.progress = [&](const nlohmann::json& status) { voice.progress(status); };
  settings.signal = [] { return SignalWatch::received(); };
  coordinator::FinishRun end;
  std::string summary;
  ClusterRecord last;
  {
    coordinator::Coordinator coordinator(std::move(settings));
    voice.say(fmt::format("the run is in {}; see \"fexp cluster status\"", directory.path().string()));
    end = coordinator.run();
    summary = coordinator.summary();
    last = coordinator.record();
  }
  try {
    write_thread_table(directory, last);
  } catch (const io::OutputError& error) {
    // A table that is missing makes the run no less complete.
    voice.say(error.what());
  }
  if (!quiet && !json) {
    print_out(summary + thread_table(last));
  }
  return report(end, directory, json);
}

/// The deck as the run's machines will read it. Wrong input ends here, before anything is launched.
std::string read_deck(const std::string& deck, io::InputFiles& files) {
  std::string bytes;
  parallel::with_threads(0, [&] { bytes = load_case(deck, files).deck_bytes; });
  return bytes;
}

/// Removes what an earlier cluster run wrote there, unless it is still alive.
void clear_earlier_cluster_run(const ClusterRunOptions& options) {
  const fs::path run = options.out.empty() ? fs::path(options.deck).stem().string() + ".run" : options.out;
  if (!options.force || !fs::exists(run / "cluster.lock")) {
    return;
  }
  const coordinator::RunLock lock(run);
  std::error_code ignored;
  for (const char* name : {"cluster.json", "cluster.log"}) {
    fs::remove(run / name, ignored);
  }
}

}  // namespace

ExitCode cluster_run(const ClusterRunOptions& options) {
  ClusterRecord record;
  ErrorList errors;
  io::InputFiles files;
  const std::string deck_bytes = read_deck(options.deck, files);
  record.machines = first_machines(options, errors);
  for (const std::string& event : options.events) {
    record.events.push_back(parse_event(event, errors));
  }
  check_mpirun(errors);
  errors.throw_if_any();
  clear_earlier_cluster_run(options);
  const auto created = io::RunDirectory::create(options.deck, deck_bytes, options.out, options.force);
  io::write_durably(created.inputs(), files.pack());
  const io::RunDirectory directory(fs::absolute(created.path()).lexically_normal());
  const coordinator::RunLock lock(directory.path());
  record.run_id = coordinator::new_run_id();
  if (!options.hosts.empty() || !options.discover.empty()) {
    record.listed = record.machines;
  }
  // A script on the PATH is named without a folder.
  const bool is_path = options.discover.find('/') != std::string::npos;
  record.options = {absolute(options.deck),
                    absolute(options.hosts),
                    is_path ? absolute(options.discover) : options.discover,
                    options.agent,
                    options.mpirun,
                    options.threads,
                    options.hash_every,
                    options.checkpoint_seconds,
                    name_of(options.placement),
                    options.quiet};
  return coordinate(directory, record, options.quiet, options.json);
}

ExitCode cluster_resume(const ClusterResumeOptions& options) {
  const io::RunDirectory directory(fs::absolute(options.run).lexically_normal());
  ClusterRecord record = coordinator::read_record(directory.path());
  const coordinator::RunLock lock(directory.path());
  record = coordinator::read_record(directory.path());  // As it is now that nobody else writes it
  if (record.state == "running" && io::is_completed(directory.summary())) {
    // The coordinator was lost before it heard of the end.
    record.state = "completed";
    coordinator::write_record(directory.path(), record);
  }
  ErrorList errors;
  if (record.state == "completed" || record.state == "fault") {
    errors.add({options.run}, fmt::format("the run is over ({})", record.state), "a run that was ended or lost",
               "begin a new one with \"fexp cluster run\"");
  }
  check_mpirun(errors);
  errors.throw_if_any();
  return coordinate(directory, record, options.quiet, options.json);
}

}  // namespace fexp::app
