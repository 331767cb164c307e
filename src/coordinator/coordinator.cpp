// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <system_error>
#include <utility>

#include "coordinator/mpirun_command.hpp"
#include "coordinator/places.hpp"
#include "io/output_error.hpp"

namespace fexp::coordinator {

namespace {

using Purpose = ProbeCrew::Purpose;

constexpr int wait_milliseconds = 100;
constexpr double check_limit = 8.0;
constexpr double look_limit = 2.0;
constexpr double clean_limit = 4.0;
/// What mpirun may take to end its ranks when asked to.
constexpr double mercy = 0.5;
/// Longer without a look around: this process was stopped, or the machine slept.
constexpr double sleep_limit = 2.0;

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string date_and_time() { return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::localtime(std::time(nullptr))); }

Membership::Settings membership_settings(const ClusterRecord& record) {
  return {FEXP_VERSION, is_own_address, record.events, record.next_world(), {}};
}

const char* state_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::completed:
      return "completed";
    case Outcome::fault:
      return "fault";
    case Outcome::stopped:
      return "stopped";
    case Outcome::gave_up:
      return "gave up";
  }
  return "";
}

}  // namespace

Coordinator::Coordinator(CoordinatorSettings settings)
    : settings_(std::move(settings)),
      membership_(membership_settings(settings_.record)),
      server_(socket_file(settings_.record.run_id)),
      source_(settings_.record.options.hosts, settings_.record.options.script) {
  ClusterRecord& record = settings_.record;
  record.state = "running";
  record.host = own_name();
  record.pid = getpid();
  record.socket = socket_file(record.run_id).string();
}

Coordinator::~Coordinator() = default;

FinishRun Coordinator::run() {
  clean_leftovers();
  double last = now_seconds();
  for (const Machine& machine : settings_.record.machines) {
    membership_.want(last, machine);
  }
  while (!finish_) {
    const double now = now_seconds();
    if (now - last > sleep_limit) {
      membership_.woke_up(now);
    }
    last = now;
    look_around(now);
    perform(now);
    save();
    if (!finish_) {
      wait(wait_milliseconds);
    }
  }
  close_world(finish_->message);
  if (finish_->outcome == Outcome::completed || finish_->outcome == Outcome::fault) {
    forget_everything();
  }
  settings_.record.state = state_text(finish_->outcome);
  settings_.record.message = finish_->message;
  save();
  return *finish_;
}

void Coordinator::look_around(double now) {
  // What the world said before it left is heard before its end is noticed.
  if (launcher_) {
    launcher_->look();
  }
  receive(now);
  look_at_launcher(now);
  collect_probes(now);
  look_for_machines(now);
  const int signal = settings_.signal();
  if (signal != signal_seen_) {
    signal_seen_ = signal;
    say("the run is to end");
    membership_.stop(now);
  }
  membership_.tick(now);
}

void Coordinator::look_at_launcher(double now) {
  if (killing_ && !cleaning_) {
    if (launcher_ && !launcher_->exited() && now - killed_at_ > mercy) {
      launcher_->send_signal(SIGKILL);
    }
    if (!launcher_ || launcher_->exited()) {
      cleaning_ = true;
      for (const Machine& machine : killing_->machines) {
        probe(Purpose::clean, machine, now, {"--kill-below", std::to_string(killing_->world + 1)}, clean_limit);
      }
    }
    return;
  }
  if (!killing_ && launcher_ && launcher_->exited()) {
    const std::string output = launcher_->output() + launcher_->errors();
    const LaunchFailure failure = explain_launch_failure(output, launcher_->status_text(), launched_->ranks);
    close_world(failure.words);
    if (!output.empty()) {
      settings_.note(fmt::format("mpirun of world {} wrote:\n{}", launched_->world, output));
    }
    membership_.launcher_exited(now, failure.words, failure.rank, failure.killed);
  }
}

void Coordinator::collect_probes(double now) {
  for (const ProbeCrew::Answer& answer : crew_.take_answers(now)) {
    const bool reached = answer.probe.has_value();
    const Probe probe = answer.probe.value_or(Probe{});
    if (answer.purpose == Purpose::check) {
      membership_.checked(now, answer.machine, {reached, answer.words, probe.version, probe.has_mpi});
    } else if (answer.purpose == Purpose::look) {
      look_answers_.push_back({answer.machine.name, reached, answer.words, probe.heartbeat_age, probe.has_worker});
    } else if (answer.purpose == Purpose::clean && !reached) {
      unreached_.push_back({answer.machine.name, answer.words});
    }
  }
  if (!look_answers_.empty() && !crew_.is_busy_with(Purpose::look)) {
    membership_.looked(now, std::exchange(look_answers_, {}));
  }
  collect_clean(now);
}

void Coordinator::collect_clean(double now) {
  if (!cleaning_ || crew_.is_busy_with(Purpose::clean)) {
    return;
  }
  cleaning_ = false;
  killing_.reset();
  if (launcher_) {
    close_world(membership_.last_loss());
  }
  membership_.cleaned(now, std::exchange(unreached_, {}));
}

void Coordinator::look_for_machines(double now) {
  std::string complaint;
  const auto list = source_.look(now, complaint);
  if (!complaint.empty()) {
    say(complaint);
  }
  if (!list) {
    return;
  }
  std::vector<Machine>& listed = settings_.record.listed;
  if (list->empty()) {
    say("the list of machines is empty; the last one stays in force");
    return;
  }
  for (const Machine& machine : *list) {
    if (std::ranges::find(listed, machine) == listed.end()) {
      membership_.want(now, machine);
    }
  }
  for (const Machine& machine : listed) {
    if (std::ranges::find(*list, machine.name, &Machine::name) == list->end()) {
      static_cast<void>(membership_.unwant(now, machine.name));
    }
  }
  listed = *list;
}

void Coordinator::perform(double now) {
  for (const Action& action : membership_.take_actions()) {
    if (const auto* check = std::get_if<CheckMachine>(&action)) {
      probe(Purpose::check, check->machine, now, {"--kill-below", std::to_string(check->below)}, check_limit);
    } else if (const auto* look = std::get_if<LookAt>(&action)) {
      for (const Machine& machine : look->machines) {
        probe(Purpose::look, machine, now, {}, look_limit);
      }
    } else if (const auto* world = std::get_if<LaunchWorld>(&action)) {
      launch(*world);
    } else if (std::holds_alternative<AskReform>(action)) {
      tell_world("reform");
    } else if (std::holds_alternative<AskStop>(action)) {
      tell_world("stop");
    } else if (const auto* kill = std::get_if<KillWorld>(&action)) {
      killing_ = *kill;
      killed_at_ = now;
      crew_.give_up(Purpose::look);
      look_answers_.clear();
      if (launcher_) {
        launcher_->send_signal(SIGTERM);
      }
    } else if (const auto* finish = std::get_if<FinishRun>(&action)) {
      finish_ = *finish;
    } else if (const auto* words = std::get_if<Tell>(&action)) {
      say(words->text);
    }
  }
}

void Coordinator::launch(const LaunchWorld& world) {
  const ClusterOptions& options = settings_.record.options;
  const std::vector<std::string> command =
      mpirun_command({settings_.record.run_id, world.world, world.ranks, world.writer_only, settings_.record.socket,
                      options.threads, options.agent, options.mpirun, settings_.worker});
  std::map<std::string, std::string> environment;
  if (geteuid() == 0) {
    environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}};
  }
  say(fmt::format("world {} begins on {}", world.world, names_text(world.ranks)));
  settings_.note(fmt::format("{}", fmt::join(command, " ")));
  world_client_.reset();
  worker_status_ = nlohmann::json::object();
  end_reason_.clear();
  WorldRecord record{world.world, {}, date_and_time(), "", {}};
  for (const Machine& machine : world.ranks) {
    used_[machine.name] = machine;
    record.machines.push_back(to_text(machine));
  }
  settings_.record.worlds.push_back(std::move(record));
  // Before it begins, so that whoever goes on after this process gives its number to no other one.
  save();
  launched_ = world;
  launcher_ = std::make_unique<ChildProcess>(command, environment);
}

void Coordinator::probe(Purpose purpose, const Machine& machine, double now, const std::vector<std::string>& more,
                        double limit) {
  std::vector<std::string> words = settings_.program;
  words.insert(words.end(), {"probe", "--run-id", settings_.record.run_id, "--machine", machine.name});
  words.insert(words.end(), more.begin(), more.end());
  const bool is_own = is_own_address(machine.address);
  crew_.start(purpose, machine, remote_command(settings_.record.options.agent, machine, is_own, words), now, limit);
}

void Coordinator::close_world(const std::string& why) {
  launcher_.reset();
  world_client_.reset();
  if (!settings_.record.worlds.empty() && settings_.record.worlds.back().ended.empty()) {
    settings_.record.worlds.back().ended = end_reason_.empty() ? why : end_reason_;
  }
}

void Coordinator::clean_leftovers() {
  if (settings_.record.worlds.empty()) {
    return;
  }
  say("ending what is left of the last world");
  std::map<std::string, Machine> machines;
  ErrorList ignored;
  const std::vector<WorldRecord>& worlds = settings_.record.worlds;
  for (const WorldRecord& world : worlds) {
    for (const std::string& text : world.machines) {
      const Machine machine =
          text.starts_with(writer_name) ? Machine{writer_name, "localhost", 1} : parse_machine(text, {}, ignored);
      // What it keeps in memory is to be forgotten in the end, too.
      used_[machine.name] = machine;
      if (&world == &worlds.back()) {
        machines[machine.name] = machine;
      }
    }
  }
  machines.emplace(writer_name, Machine{writer_name, "localhost", 1});
  const double start = now_seconds();
  for (const auto& [name, machine] : machines) {
    probe(Purpose::clean, machine, start, {"--kill-below", std::to_string(settings_.record.next_world())}, clean_limit);
  }
  while (crew_.is_busy_with(Purpose::clean)) {
    wait(wait_milliseconds);
    for (const ProbeCrew::Answer& answer : crew_.take_answers(now_seconds())) {
      if (!answer.probe) {
        say(fmt::format("{} could not be cleaned up: {}", answer.machine.name, answer.words));
      }
    }
  }
  if (settings_.record.worlds.back().ended.empty()) {
    settings_.record.worlds.back().ended = "lost with its coordinator";
  }
}

void Coordinator::forget_everything() {
  const double start = now_seconds();
  for (const auto& [name, machine] : used_) {
    probe(Purpose::forget, machine, start, {"--forget"}, look_limit);
  }
  while (crew_.is_busy_with(Purpose::forget)) {
    wait(wait_milliseconds);
    static_cast<void>(crew_.take_answers(now_seconds()));
  }
}

void Coordinator::save() {
  ClusterRecord& record = settings_.record;
  record.machines = membership_.wanted();
  record.events = membership_.events();
  if (to_json(record) == saved_) {
    return;
  }
  try {
    write_record(settings_.run, record);
    saved_ = to_json(record);
    save_failed_ = false;
  } catch (const io::OutputError& error) {
    if (!std::exchange(save_failed_, true)) {
      say(error.what());
    }
  }
}

void Coordinator::say(const std::string& text) {
  last_said_ = text;
  settings_.say(text);
}

void Coordinator::wait(int milliseconds) {
  std::vector<pollfd> waiting;
  const auto add = [&](const std::vector<int>& descriptors) {
    for (const int descriptor : descriptors) {
      if (descriptor >= 0) {
        waiting.push_back({descriptor, POLLIN, 0});
      }
    }
  };
  add(server_.descriptors());
  add(source_.descriptors());
  add(crew_.descriptors());
  if (launcher_ && !launcher_->exited()) {
    add(launcher_->descriptors());
  }
  static_cast<void>(poll(waiting.data(), waiting.size(), milliseconds));
}

}  // namespace fexp::coordinator
