// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/cluster_run.hpp"
#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "base/errors.hpp"
#include "coordinator/line_connection.hpp"
#include "coordinator/places.hpp"
#include "coordinator/record.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;
using coordinator::LineConnection;
using Json = nlohmann::json;
using Action = std::function<ExitCode()>;

constexpr double answer_seconds = 10.0;

/// None when it does not answer in time.
std::optional<Json> ask(LineConnection& connection, const Json& question) {
  connection.send(question);
  return coordinator::wait_for_message(connection, answer_seconds);
}

[[noreturn]] void refuse(const std::string& place, const std::string& message, const std::string& cure) {
  ErrorList errors;
  errors.add({place, 0, 0}, message, "", cure);
  errors.throw_if_any();
  std::abort();
}

/// The coordinators of this user that live on this machine.
std::vector<LineConnection> living_coordinators() {
  std::vector<LineConnection> living;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(coordinator::socket_folder(), error)) {
    if (entry.path().extension() == ".sock") {
      if (auto connection = coordinator::connect_to(entry.path())) {
        living.push_back(std::move(*connection));
      }
    }
  }
  return living;
}

LineConnection coordinator_of(const std::string& run) {
  if (!run.empty()) {
    const coordinator::ClusterRecord record = coordinator::read_record(run);
    if (auto connection = coordinator::connect_to(record.socket)) {
      return std::move(*connection);
    }
    const bool elsewhere = record.host != coordinator::own_name();
    refuse(run, "the coordinator of this run does not live on this machine",
           elsewhere ? "try on " + record.host + ", where it was started"
                     : "\"fexp cluster resume " + run + "\" goes on with the run, unless it is over");
  }
  std::vector<LineConnection> living = living_coordinators();
  if (living.empty()) {
    refuse("", "no cluster run of yours lives on this machine", "name one with --run");
  }
  if (living.size() > 1) {
    std::string runs;
    for (LineConnection& connection : living) {
      runs += " " + ask(connection, {{"command", "status"}}).value_or(Json::object()).value("run", "");
    }
    refuse("", fmt::format("{} cluster runs of yours live on this machine:{}", living.size(), runs),
           "name one with --run");
  }
  return std::move(living.front());
}

Json ask_or_refuse(const std::string& run, const Json& question) {
  LineConnection connection = coordinator_of(run);
  const auto answer = ask(connection, question);
  if (!answer) {
    refuse(run, "the coordinator does not answer", "try again; it may be stopped or about to end");
  }
  return *answer;
}

/// Add, remove, stop.
ExitCode command(const std::string& run, const Json& question) {
  const Json answer = ask_or_refuse(run, question);
  const std::string text = answer.value("text", "");
  if (!answer.value("ok", false)) {
    print_error(fmt::format("fexp: {}\n", text));
    return ExitCode::wrong_input;
  }
  print_out(text + "\n");
  return ExitCode::done;
}

std::string status_text(const Json& status) {
  std::string text = fmt::format("{}: {}, world {}, step {}\n", status.value("run", ""), status.value("phase", ""),
                                 status.value("world", 0), status.value("step", std::int64_t{0}));
  const Json machines = status.value("machines", Json::array());
  const Json worker = status.value("worker", Json::object());
  for (const Json& machine : machines) {
    text += fmt::format("  {:<16} {}", machine.value("name", ""), machine.value("state", ""));
    if (machine.value("retry_in", Json()).is_number()) {
      text += fmt::format(", tried again in {:.0f} s", machine.value("retry_in", 0.0));
    }
    const std::string reason = machine.value("reason", "");
    text += reason.empty() ? "\n" : fmt::format(": {}\n", reason);
  }
  for (const auto& [key, value] : worker.items()) {
    if (key != "event" && key != "step") {
      text += fmt::format("  {}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return text + fmt::format("  last: {}\n", status.value("message", ""));
}

ExitCode status(const std::string& run, bool as_json) {
  const Json answer = ask_or_refuse(run, {{"command", "status"}});
  if (as_json) {
    print_json(nlohmann::ordered_json(answer));
  } else {
    print_out(status_text(answer));
  }
  return ExitCode::done;
}

void add_run_option(CLI::App& options, std::string& run) {
  options.add_option("--run", run, "Directory of the run; needed when several live on this machine")
      ->option_text("RUN");
}

void add_quiet_option(CLI::App& options, bool& quiet) { options.add_flag("--quiet", quiet, "Print errors only"); }

Action declare_run(CLI::App& app) {
  auto options = std::make_shared<ClusterRunOptions>();
  add_deck_option(app, options->deck);
  CLI::Option* hosts =
      app.add_option("--hosts", options->hosts,
                     "Hosts file as mpirun's (\"name slots=8\"); watched: what appears joins, what vanishes leaves")
          ->option_text("FILE");
  app.add_option("--discover", options->discover, "Program that prints such a list, run every few seconds")
      ->option_text("SCRIPT")
      ->excludes(hosts);
  app.add_option("--out", options->out, "Directory for the results; DECK.run, DECK-2.run ... when left out")
      ->option_text("DIR");
  app.add_flag("--force", options->force, "Replace the results in the directory");
  add_threads_option(app, options->threads);
  app.add_option("--agent", options->agent, "Program that runs a command on a machine, called like ssh")
      ->option_text("PROGRAM");
  app.add_option("--mpirun", options->mpirun, "More options for mpirun, in one word")->option_text("\"OPTIONS\"");
  app.add_option("--hash-every", options->hash_every,
                 "Write a hash of every body after every N steps, for \"fexp compare\"")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62))
      ->option_text("N");
  add_checkpoint_option(app, options->checkpoint_seconds);
  add_placement_option(app, options->placement);
  app.add_option("--at", options->events, "Change the machines at a step; may be given several times")
      ->option_text("\"STEP add|remove HOST\"")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_quiet_option(app, options->quiet);
  add_json_option(app, options->json, "Print the summary as JSON, and nothing else, on the standard output");
  return [options] { return cluster_run(*options); };
}

Action declare_resume(CLI::App& app) {
  auto options = std::make_shared<ClusterResumeOptions>();
  app.add_option("RUN", options->run, "Directory of the run")->required();
  add_quiet_option(app, options->quiet);
  add_json_option(app, options->json, "Print the summary as JSON, and nothing else, on the standard output");
  return [options] { return cluster_resume(*options); };
}

struct TalkOptions {
  std::string run;
  std::string machine;
  bool json{};
};

Action declare_change(CLI::App& app, const char* what, const char* meaning) {
  auto options = std::make_shared<TalkOptions>();
  app.add_option("HOST", options->machine, meaning)->required();
  add_run_option(app, options->run);
  return [options, what] { return command(options->run, {{"command", what}, {"machine", options->machine}}); };
}

Action declare_status(CLI::App& app) {
  auto options = std::make_shared<TalkOptions>();
  add_run_option(app, options->run);
  add_json_option(app, options->json, "Print JSON");
  return [options] { return status(options->run, options->json); };
}

Action declare_stop(CLI::App& app) {
  auto options = std::make_shared<TalkOptions>();
  add_run_option(app, options->run);
  return [options] { return command(options->run, {{"command", "stop"}}); };
}

Action declare_cluster(CLI::App& app) {
  app.require_subcommand(1);
  auto actions = std::make_shared<std::vector<std::pair<CLI::App*, Action>>>();
  const auto add = [&](const char* name, const char* purpose, const std::function<Action(CLI::App&)>& declare_it) {
    CLI::App* options = app.add_subcommand(name, purpose);
    actions->emplace_back(options, declare_it(*options));
  };
  add("run", "Integrate a deck on several machines, whichever of them come, go or fail", declare_run);
  add("add", "Let a machine join", [](CLI::App& options) {
    return declare_change(options, "add", "NAME, NAME:SLOTS, or NAME=ADDRESS for a name of your own");
  });
  add("remove", "Let a machine leave",
      [](CLI::App& options) { return declare_change(options, "remove", "Name of the machine"); });
  add("status", "Tell how a run and its machines are", declare_status);
  add("stop", "End a run in order; it can be resumed", declare_stop);
  add("resume", "Go on with a run that was stopped, or whose coordinator was lost", declare_resume);
  return [actions] {
    for (const auto& [options, action] : *actions) {
      if (options->parsed()) {
        return action();
      }
    }
    return ExitCode::internal;
  };
}

}  // namespace

const Command cluster_command{"cluster", "Run on several machines through MPI, which may come, go and fail",
                              "  fexp cluster run four_spheres.toml --hosts hosts.txt\n"
                              "  fexp cluster run plate.toml --discover /usr/share/fexp/cluster/discover-slurm.sh\n"
                              "  fexp cluster add node7:16               while it runs\n"
                              "  fexp cluster status\n"
                              "  fexp cluster resume plate.run           after the coordinator's machine was restarted",
                              declare_cluster};

}  // namespace fexp::app
