// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "base/process_threads.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/places.hpp"

/// The part of Coordinator that talks over its socket, to rank 0 of the world and to the user's commands.
namespace fexp::coordinator {

namespace {

nlohmann::json done(const std::string& text) { return {{"ok", true}, {"text", text}}; }
nlohmann::json refused(const std::string& text) { return {{"ok", false}, {"text", text}}; }

std::string text_of(const nlohmann::json& message, const char* key) {
  const auto found = message.find(key);
  return found != message.end() && found->is_string() ? found->get<std::string>() : "";
}

std::int64_t number_of(const nlohmann::json& message, const char* key, std::int64_t otherwise) {
  const auto found = message.find(key);
  return found != message.end() && found->is_number() ? found->get<std::int64_t>() : otherwise;
}

}  // namespace

void Coordinator::receive(double now) {
  for (const ControlServer::Message& message : server_.receive()) {
    receive_message(now, message);
  }
  for (const int client : server_.take_left()) {
    if (client == world_client_) {
      world_client_.reset();
      membership_.connection_lost(now);
    }
  }
}

void Coordinator::receive_message(double now, const ControlServer::Message& message) {
  if (text_of(message.content, "hello") == "world") {
    greet(now, message.client, message.content);
  } else if (message.client == world_client_) {
    receive_from_world(now, message.content);
  } else {
    server_.send(message.client, answer_command(now, message.content));
  }
}

void Coordinator::greet(double now, int client, const nlohmann::json& hello) {
  const std::int64_t world = number_of(hello, "world", 0);
  if (!launcher_ || killing_ || membership_.world() != world) {
    server_.send(client, {{"error", fmt::format("world {} is over", world)}});
    return;
  }
  const ClusterOptions& options = settings_.record.options;
  nlohmann::json machines = nlohmann::json::array();
  for (const Machine& machine : launched_->ranks) {
    machines.push_back(machine.name);
  }
  world_client_ = client;
  server_.send(client, {{"run", settings_.run.string()},
                        {"deck", options.deck},
                        {"deck_copy", (settings_.run / "deck.toml").string()},
                        {"run_id", settings_.record.run_id},
                        {"world", world},
                        {"machines", std::move(machines)},
                        {"writer_only", launched_->writer_only},
                        {"events", membership_.event_steps()},
                        {"options",
                         {{"hash_every", options.hash_every},
                          {"checkpoint_seconds", options.checkpoint_seconds},
                          {"placement", options.placement},
                          {"threads", options.threads},
                          {"quiet", options.quiet}}}});
  membership_.connected(now);
  if (stop_pending_) {
    tell_world("stop");
  }
}

void Coordinator::receive_from_world(double now, const nlohmann::json& message) {
  const std::string event = text_of(message, "event");
  const std::int64_t step = number_of(message, "step", membership_.step());
  if (event == "started") {
    say(fmt::format("world {} is stepping, from step {}", launched_->world, step));
    membership_.started(now, step);
  } else if (event == "note") {
    say(text_of(message, "text"));
  } else if (event == "status") {
    membership_.advanced(now, step);
    worker_status_ = message;
    note_threads(message);
    settings_.progress(message);
  } else if (event == "summary") {
    summary_ = text_of(message, "text");
  } else if (event == "ended") {
    end_reason_ = text_of(message, "reason");
    membership_.ended(now, {text_of(message, "reason"), static_cast<int>(number_of(message, "exit_code", 0)),
                            text_of(message, "message"), step});
  }
}

/// Once for each world.
void Coordinator::note_threads(const nlohmann::json& status) {
  WorldThreads& threads = settings_.record.worlds.back().threads;
  if (!threads.machines.empty() || !status.contains("machines") || !launcher_) {
    return;
  }
  for (const nlohmann::json& machine : status["machines"]) {
    threads.machines.push_back({text_of(machine, "name"), static_cast<int>(number_of(machine, "native_threads", 0)),
                                static_cast<int>(number_of(machine, "running_threads", 0)),
                                static_cast<int>(number_of(machine, "threads", 0))});
  }
  threads.coordinator = process_threads();
  threads.mpirun = process_threads(launcher_->id());
  threads.launch_agents = static_cast<int>(
      std::ranges::count_if(launched_->ranks, [](const Machine& machine) { return !is_own_address(machine.address); }));
}

void Coordinator::tell_world(const char* command) {
  stop_pending_ = stop_pending_ || std::string_view(command) == "stop";
  if (world_client_) {
    server_.send(*world_client_, {{"command", command}});
  }
}

nlohmann::json Coordinator::answer_command(double now, const nlohmann::json& message) {
  const std::string command = text_of(message, "command");
  if (command == "status") {
    return status(now);
  }
  if (command == "stop") {
    say("the run is to end: \"fexp cluster stop\"");
    membership_.stop(now);
    return done("the run ends at the next boundary of epochs; once more ends it at once");
  }
  if (command == "add") {
    return answer_add(now, text_of(message, "machine"));
  }
  if (command == "remove") {
    return answer_remove(now, text_of(message, "machine"));
  }
  return refused(fmt::format("unknown command \"{}\"", command));
}

nlohmann::json Coordinator::answer_add(double now, const std::string& text) {
  ErrorList errors;
  const Machine machine = parse_machine(text, {}, errors);
  if (!errors.empty()) {
    return refused(errors.errors().front().text());
  }
  const std::vector<Machine> wanted = membership_.wanted();
  const auto same = std::ranges::find(wanted, machine.name, &Machine::name);
  if (same != wanted.end() && same->address != machine.address) {
    return refused(fmt::format("there is a machine {} already, at {}", machine.name, same->address));
  }
  membership_.want(now, machine);
  return done(fmt::format("{} joins at a boundary of epochs as soon as it answers", machine.name));
}

nlohmann::json Coordinator::answer_remove(double now, const std::string& name) {
  const std::vector<Machine> wanted = membership_.wanted();
  if (std::ranges::find(wanted, name, &Machine::name) == wanted.end()) {
    return refused(fmt::format("no machine \"{}\"; there are {}", name, names_text(wanted)));
  }
  if (wanted.size() == 1) {
    return refused(fmt::format("{} is the last machine; end the run with \"fexp cluster stop\"", name));
  }
  static_cast<void>(membership_.unwant(now, name));
  return done(fmt::format("{} leaves at the next boundary of epochs", name));
}

nlohmann::json Coordinator::status(double now) const {
  nlohmann::json machines = nlohmann::json::array();
  for (const Membership::MachineView& view : membership_.machines(now)) {
    nlohmann::json machine{{"name", view.machine.name},   {"address", view.machine.address},
                           {"slots", view.machine.slots}, {"state", view.state},
                           {"reason", view.reason},       {"retry_in", nullptr}};
    if (view.retry_in) {
      machine["retry_in"] = *view.retry_in;
    }
    machines.push_back(std::move(machine));
  }
  const ClusterRecord& record = settings_.record;
  return {{"run", settings_.run.string()},
          {"run_id", record.run_id},
          {"pid", record.pid},
          {"phase", membership_.phase()},
          {"world", membership_.world().value_or(0)},
          {"worlds", record.worlds.size()},
          {"step", membership_.step()},
          {"machines", std::move(machines)},
          {"events", membership_.event_steps()},
          {"message", last_said_},
          {"worker", worker_status_}};
}

}  // namespace fexp::coordinator
