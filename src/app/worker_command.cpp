// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "app/command.hpp"
#include "app/options.hpp"
#include "app/run_driver.hpp"
#include "app/saved_run.hpp"
#include "app/signals.hpp"
#include "app/take_ups.hpp"
#include "app/with_ranks.hpp"
#include "app/worker_link.hpp"
#include "coordinator/control_channel.hpp"
#include "coordinator/places.hpp"
#include "io/checkpoint_files.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

constexpr double greeting_seconds = 20.0;

struct WorkerOptions {
  std::string run_id;
  int world{};
  std::string socket;
  int threads{};
  bool writer_only{};
};

/// Held while this worker lives, so that the next world's worker on this machine does not read what this one writes.
class WorkerLock {
 public:
  explicit WorkerLock(const fs::path& path) : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (file_ < 0 || flock(file_, LOCK_EX) != 0) {
      throw std::runtime_error("cannot lock " + path.string());
    }
  }
  WorkerLock(const WorkerLock&) = delete;
  WorkerLock& operator=(const WorkerLock&) = delete;
  ~WorkerLock() { ::close(file_); }

 private:
  int file_;
};

/// What the coordinator says to rank 0, on all ranks.
nlohmann::json greeting_of(Ranks& ranks, std::optional<coordinator::ControlClient>& channel) {
  std::string text = "{}";
  if (channel) {
    text =
        channel->wait(greeting_seconds).value_or(nlohmann::json{{"error", "the coordinator does not answer"}}).dump();
  }
  const Bytes all = ranks.from_first(std::as_bytes(std::span(text.data(), text.size())));
  auto greeting = nlohmann::json::parse(std::string(reinterpret_cast<const char*>(all.data()), all.size()));
  if (greeting.contains("error")) {
    throw std::runtime_error(greeting["error"].get<std::string>());
  }
  return greeting;
}

/// The checkpoint on the disk, where there is one.
std::optional<SavedRun> on_disk(const io::RunDirectory& directory, WorkerLink& link) {
  const io::CheckpointFiles files(directory.checkpoints());
  if (files.steps().empty()) {
    return std::nullopt;
  }
  try {
    const io::FoundCheckpoint found = files.newest();
    for (const std::string& sentence : found.passed_over) {
      link.send({{"event", "note"}, {"text", sentence}});
    }
    return SavedRun::from(found.sections, found.path);
  } catch (const io::OutputError& error) {
    link.send({{"event", "note"}, {"text", error.what()}});
    return std::nullopt;
  }
}

/// Where the run goes on: the newest moment that the machines' memory or the disk has; nothing at the run's start.
std::optional<TakenUp> find_moment(Ranks& ranks, const MemorySnapshots& snapshots, const TakeUps& take_ups,
                                   const io::RunDirectory& directory, WorkerLink& link) {
  std::optional<MemorySnapshots::Found> memory = snapshots.newest(take_ups);
  std::optional<SavedRun> disk;
  std::int64_t disk_step = -1;
  if (ranks.is_first()) {
    disk = on_disk(directory, link);
    disk_step = disk ? disk->step : -1;
  }
  disk_step =
      ByteReader(ranks.from_first(std::as_bytes(std::span<const std::int64_t>(&disk_step, 1)))).value<std::int64_t>();
  if (!memory && disk_step < 0) {
    return std::nullopt;
  }
  TakenUp taken_up;
  if (memory && memory->step >= disk_step) {
    taken_up.mark = memory->about.mark;
    for (SavedRun& part : memory->parts) {
      taken_up.pieces.push_back(std::move(part.piece));
    }
  } else if (disk) {
    taken_up.mark = disk->mark;
    taken_up.pieces.push_back(std::move(disk->piece));
  }
  return taken_up;
}

ExitCode work_here(const WorkerOptions& options, Ranks& ranks) {
  const std::string machine = machine_name();
  coordinator::make_private_directory(coordinator::machine_memory(options.run_id, machine));
  const Heartbeat heartbeat(coordinator::heartbeat_file(options.run_id, machine));
  const WorkerLock lock(coordinator::worker_lock(options.run_id, machine));
  const SignalWatch watch;
  std::optional<coordinator::ControlClient> channel;
  if (ranks.is_first()) {
    channel.emplace(options.socket, options.world);
  }
  const nlohmann::json greeting = greeting_of(ranks, channel);
  WorkerLink link(std::move(channel), greeting.at("events").get<std::vector<std::int64_t>>());
  const io::RunDirectory directory(greeting.at("run").get<std::string>());
  io::InputFiles files;
  ranks.on_first([&] { files = io::InputFiles::packed_in(directory.inputs()); });
  const Case loaded = ranks.load(files.deck(), files);
  MemorySnapshots snapshots(coordinator::snapshot_folder(options.run_id, machine), machine, ranks.communicator());
  TakeUps take_ups;
  ranks.on_first([&] { take_ups = TakeUps::read(directory.taken_up()); });
  take_ups = TakeUps::unpack(ranks.from_first(take_ups.pack()));
  Drive run{ranks, loaded, directory, {}, find_moment(ranks, snapshots, take_ups, directory, link),
            {},    &link,  &snapshots};
  snapshots.belong_to(take_ups.count() + 1);
  run.before_output = [&](std::int64_t step) {
    take_ups.add(step);
    take_ups.write(directory.taken_up());
  };
  run.settings.world.writer_only = options.writer_only;
  run.settings.hash_every = greeting.at("options").value("hash_every", std::int64_t{0});
  run.settings.checkpoint_seconds = greeting.at("options").value("checkpoint_seconds", run.settings.checkpoint_seconds);
  const auto rule = placement_rules().find(greeting.at("options").value("placement", ""));
  run.settings.world.rule = rule != placement_rules().end() ? rule->second : run.settings.world.rule;
  run.settings.quiet = true;
  RunEnd end;
  const ExitCode code = drive(run, end);
  // One word in messages.
  std::string reason = name_of(end.reason);
  std::ranges::replace(reason, ' ', '_');
  link.send({{"event", "ended"},
             {"reason", reason},
             {"exit_code", static_cast<int>(code)},
             {"message", end.message},
             {"step", end.last_step}});
  link.finish();
  clear_saved(run, end);
  // The coordinator knows why; mpirun need not add its own words.
  return ExitCode::done;
}

std::function<ExitCode()> declare_worker(CLI::App& app) {
  auto options = std::make_shared<WorkerOptions>();
  app.add_option("--run-id", options->run_id, "The run")->required();
  app.add_option("--world", options->world, "Number of the world")->required();
  app.add_option("--socket", options->socket, "Where the coordinator listens")->required();
  add_threads_option(app, options->threads);
  app.add_flag("--writer-only", options->writer_only, "Rank 0 writes and does not compute");
  return [options] { return with_ranks(options->threads, [&](Ranks& ranks) { return work_here(*options, ranks); }); };
}

}  // namespace

const Command worker_command{"worker", "A rank of a cluster run", "  (started by \"fexp cluster run\")", declare_worker,
                             true};

}  // namespace fexp::app
