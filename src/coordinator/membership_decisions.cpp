// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "coordinator/membership.hpp"

/// The part of Membership that looks at everything and decides what comes next.
namespace fexp::coordinator {

namespace {

bool same_machines(std::vector<Machine> a, std::vector<Machine> b) {
  const auto key = [](const Machine& machine) { return std::pair(machine.name, machine.address); };
  std::ranges::sort(a, {}, key);
  std::ranges::sort(b, {}, key);
  return std::ranges::equal(a, b, {}, key, key);
}

}  // namespace

void Membership::decide(double now) {
  if (finished_) {
    return;
  }
  forget_unwanted();
  check_machines(now);
  if (world_) {
    watch(now);
  } else if (stop_asked_) {
    finish(Outcome::stopped, 0, "");
  } else {
    launch(now);
  }
}

void Membership::forget_unwanted() {
  std::erase_if(hosts_, [this](const Host& host) { return !host.wanted && !computes(host.machine.name); });
}

void Membership::check_machines(double now) {
  if (stop_asked_) {
    return;
  }
  for (Host& host : hosts_) {
    if (host.wanted && !host.good && !host.checking && (!host.left_out || now >= host.retry_at)) {
      host.checking = true;
      actions_.emplace_back(CheckMachine{host.machine, world_ ? world_->number : next_world_});
    }
  }
}

void Membership::launch(double now) {
  if (now < not_before_ || waits_for_checks()) {
    return;
  }
  if (next_world_ == settings_.first_world) {
    apply_events(now, 0);
    check_machines(now);
    if (waits_for_checks()) {
      return;
    }
  }
  std::vector<Machine> machines = usable();
  if (machines.empty()) {
    if (!std::exchange(told_nobody_, true)) {
      tell("no machine can be used now; the run waits until one answers or is added");
    }
    return;
  }
  told_nobody_ = false;
  World world;
  world.number = next_world_++;
  world.computing = machines;
  world.launched = world.last_news = now;
  world.next_look = now + settings_.timing.shortest_stall;
  LaunchWorld action{world.number, std::move(machines), false};
  if (!settings_.is_own(action.ranks.front().address)) {
    action.writer_only = true;
    action.ranks.insert(action.ranks.begin(), {writer_name, "localhost", 1});
  }
  world.ranks = action.ranks;
  world_ = std::move(world);
  actions_.emplace_back(std::move(action));
}

void Membership::watch(double now) {
  World& world = *world_;
  const Timing& timing = settings_.timing;
  if (world.killing) {
    return;
  }
  if (world.ended_at) {
    if (now - *world.ended_at > timing.leave) {
      // What it said counts, whatever keeps it from leaving.
      world.killing = true;
      actions_.emplace_back(KillWorld{world.number, world.ranks});
    }
    return;
  }
  if (world.connection_lost_at && now - *world.connection_lost_at > timing.leave) {
    lose("rank 0 left without a word", {});
    return;
  }
  if (stop_asked_) {
    if (now - *stop_asked_ > timing.stop) {
      lose("it does not end although asked to", {});
    }
    return;
  }
  const double limit = !world.connected ? timing.launch
                       : !world.started ? timing.load
                                        : std::max(timing.patience, timing.patience_gaps * world.longest_gap);
  const double since = world.connected ? world.last_news : world.launched;
  if (now - since > limit) {
    lose(fmt::format("no news for {:.0f} s, although all machines answer", now - since), {});
    return;
  }
  if (!world.looking_since && now >= world.next_look) {
    world.looking_since = now;
    world.next_look = now + std::max(timing.shortest_stall, timing.stall_gaps * world.longest_gap);
    actions_.emplace_back(LookAt{world.ranks});
  }
  const std::vector<Machine> machines = usable();
  if (world.started && !world.reform_asked && !machines.empty() && !waits_for_checks() &&
      !same_machines(machines, world.computing)) {
    world.reform_asked = true;
    tell(fmt::format("the machines change to {}", names_text(machines)));
    actions_.emplace_back(AskReform{});
  }
}

void Membership::finish(Outcome outcome, int exit_code, const std::string& message) {
  finished_ = true;
  actions_.emplace_back(FinishRun{outcome, exit_code, message});
}

std::vector<Action> Membership::take_actions() { return std::exchange(actions_, {}); }

Membership::Host* Membership::find(std::string_view name) {
  const auto host = std::ranges::find(hosts_, name, [](const Host& h) -> std::string_view { return h.machine.name; });
  return host == hosts_.end() ? nullptr : &*host;
}

std::vector<Machine> Membership::usable() const {
  std::vector<Machine> machines;
  for (const Host& host : hosts_) {
    if (host.wanted && host.good) {
      machines.push_back(host.machine);
    }
  }
  // Rank 0 writes the results, so it must be here.
  std::stable_partition(machines.begin(), machines.end(),
                        [this](const Machine& m) { return settings_.is_own(m.address); });
  return machines;
}

bool Membership::waits_for_checks() const {
  return std::ranges::any_of(hosts_, [](const Host& host) { return host.checking && !host.left_out; });
}

bool Membership::computes(std::string_view name) const {
  return world_ && std::ranges::any_of(world_->computing, [&](const Machine& m) { return m.name == name; });
}

std::vector<Membership::MachineView> Membership::machines(double now) const {
  std::vector<MachineView> views;
  for (const Host& host : hosts_) {
    MachineView view{host.machine, "", host.reason, std::nullopt};
    if (computes(host.machine.name) && !world_->killing) {
      view.state = host.wanted ? "computing" : "leaving";
    } else if (host.left_out) {
      view.state = "left out";
      view.retry_in = std::max(0.0, host.retry_at - now);
    } else {
      view.state = host.good ? "ready" : "being checked";
    }
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<Machine> Membership::wanted() const {
  std::vector<Machine> machines;
  for (const Host& host : hosts_) {
    if (host.wanted) {
      machines.push_back(host.machine);
    }
  }
  return machines;
}

std::vector<std::int64_t> Membership::event_steps() const {
  std::vector<std::int64_t> steps;
  for (const StepEvent& event : settings_.events) {
    if (!event.applied) {
      steps.push_back(event.step);
    }
  }
  return steps;
}

std::string Membership::phase() const {
  if (finished_) {
    return "finished";
  }
  if (!world_) {
    return "waiting";
  }
  if (world_->killing) {
    return "cleaning up";
  }
  if (world_->end || world_->reform_asked) {
    return "re-forming";
  }
  return world_->started ? "running" : "starting";
}

std::optional<int> Membership::world() const { return world_ ? std::optional(world_->number) : std::nullopt; }

}  // namespace fexp::coordinator
