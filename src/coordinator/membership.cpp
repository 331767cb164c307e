// SPDX-License-Identifier: Apache-2.0
#include "coordinator/membership.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fexp::coordinator {

namespace {

double doubled(double first, double most, int times) { return std::min(first * std::exp2(std::min(times, 60)), most); }

/// What is wrong with a machine that answered; empty when nothing is.
std::string fault_of(const CheckAnswer& answer, const std::string& version) {
  if (!answer.reached) {
    return answer.words.empty() ? "it does not answer" : answer.words;
  }
  if (answer.version != version) {
    return fmt::format("it has fexp {}, and this machine has {}; install the same version on both", answer.version,
                       version);
  }
  return answer.has_mpi ? "" : "it has no Open MPI (orted is not found there); install openmpi-bin";
}

}  // namespace

Membership::Membership(Settings settings) : settings_(std::move(settings)), next_world_(settings_.first_world) {
  std::ranges::stable_sort(settings_.events, {}, &StepEvent::step);
}

void Membership::want(double now, const Machine& machine) {
  add_wanted(now, machine);
  decide(now);
}

bool Membership::unwant(double now, std::string_view name) {
  const bool found = drop_wanted(name);
  decide(now);
  return found;
}

void Membership::add_wanted(double now, const Machine& machine) {
  Host* host = find(machine.name);
  if (host == nullptr || host->machine.address != machine.address) {
    Host fresh;
    fresh.machine = machine;
    if (host == nullptr) {
      hosts_.push_back(fresh);
    } else {
      *host = fresh;
    }
  } else {
    host->machine = machine;
    host->wanted = true;
    // Whoever asks for a machine again wants it tried now.
    host->retry_at = std::min(host->retry_at, now);
  }
}

bool Membership::drop_wanted(std::string_view name) {
  Host* host = find(name);
  if (host == nullptr || !host->wanted) {
    return false;
  }
  host->wanted = false;
  return true;
}

void Membership::checked(double now, const Machine& machine, const CheckAnswer& answer) {
  Host* host = find(machine.name);
  if (host == nullptr || host->machine.address != machine.address || !host->checking) {
    return;
  }
  host->checking = false;
  const std::string fault = fault_of(answer, settings_.version);
  if (fault.empty()) {
    if (host->left_out) {
      tell(fmt::format("{} answers again", machine.name));
    }
    host->good = true;
    host->left_out = false;
    host->good_since = now;
    host->reason.clear();
  } else {
    leave_out(now, *host, fault);
  }
  decide(now);
}

void Membership::connected(double now) {
  if (world_ && !world_->killing) {
    world_->connected = true;
    news(now, false);
  }
}

void Membership::started(double now, std::int64_t step) {
  if (!world_ || world_->killing) {
    return;
  }
  world_->started = true;
  step_ = step;
  fruitless_starts_ = 0;
  news(now, false);
  // A snapshot at or after an event that no world has ended for.
  apply_events(now, step);
  decide(now);
}

void Membership::advanced(double now, std::int64_t step) {
  if (!world_ || world_->killing) {
    return;
  }
  step_ = step;
  if (step > best_step_) {
    best_step_ = step;
    world_->gained = true;
    fruitless_ = fruitless_starts_ = fruitless_kills_ = output_failures_ = 0;
  }
  news(now, world_->started);
  for (Host& host : hosts_) {
    if (host.good && computes(host.machine.name) && now - host.good_since > settings_.timing.good_conduct) {
      host.failures = 0;
    }
  }
  decide(now);
}

void Membership::news(double now, bool counts_as_gap) {
  if (counts_as_gap) {
    world_->longest_gap = std::max(world_->longest_gap, now - world_->last_news);
  }
  world_->last_news = now;
  world_->next_look =
      now + std::max(settings_.timing.shortest_stall, settings_.timing.stall_gaps * world_->longest_gap);
}

void Membership::ended(double now, const EndMessage& message) {
  if (!world_ || world_->killing) {
    return;
  }
  world_->end = message;
  world_->ended_at = now;
  step_ = message.step.value_or(step_);
}

void Membership::connection_lost(double now) {
  if (world_ && !world_->killing) {
    world_->connection_lost_at = now;
  }
}

void Membership::launcher_exited(double now, const std::string& words, std::optional<int> failed_rank, bool killed) {
  if (!world_ || world_->killing) {
    return;
  }
  const bool orderly =
      world_->end && world_->end->reason != "lost_coordinator" && (world_->end->reason != "interrupted" || stop_asked_);
  if (orderly) {
    settle(now);
    return;
  }
  if (failed_rank && *failed_rank >= 0 && static_cast<std::size_t>(*failed_rank) < world_->ranks.size()) {
    world_->died_on = world_->ranks[static_cast<std::size_t>(*failed_rank)].name;
  }
  world_->end.reset();
  world_->killed = killed;
  lose(words, {});
}

void Membership::lose(const std::string& words, const std::vector<std::string>& unreachable) {
  world_->killing = true;
  last_loss_ = words;
  unreachable_in_loss_ = !unreachable.empty();
  if (!stop_asked_) {
    tell(fmt::format("world {} is lost: {}", world_->number, words));
  }
  KillWorld kill{world_->number, {}};
  for (const Machine& machine : world_->ranks) {
    if (std::ranges::find(unreachable, machine.name) == unreachable.end()) {
      kill.machines.push_back(machine);
    }
  }
  actions_.emplace_back(std::move(kill));
}

void Membership::looked(double now, const std::vector<LookAnswer>& answers) {
  if (!world_ || world_->killing || !world_->looking_since) {
    return;
  }
  const double since = *std::exchange(world_->looking_since, std::nullopt);
  if (world_->last_news > since || world_->end) {
    return;
  }
  const Timing& timing = settings_.timing;
  const auto is_fresh = [&](const LookAnswer& answer) {
    return answer.heartbeat_age && *answer.heartbeat_age <= timing.stale_heartbeat;
  };
  const bool any_fresh = std::ranges::any_of(answers, is_fresh);
  std::vector<std::string> unreachable;
  std::string words;
  double youngest = HUGE_VAL;
  for (const LookAnswer& answer : answers) {
    youngest = std::min(youngest, answer.heartbeat_age.value_or(0.0));
    std::string wrong;
    if (!answer.reached) {
      unreachable.push_back(answer.machine);
      wrong = answer.words;
    } else if (any_fresh && answer.heartbeat_age && !is_fresh(answer)) {
      wrong = fmt::format("its worker does not run (no sign of life for {:.1f} s)", *answer.heartbeat_age);
    } else {
      continue;
    }
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", answer.machine, wrong);
    world_->culprits.emplace(answer.machine, std::move(wrong));
  }
  if (!words.empty()) {
    lose(fmt::format("no news for {:.1f} s; {}", now - world_->last_news, words), unreachable);
  } else if (!answers.empty() && youngest > timing.all_stale) {
    lose(fmt::format("no news for {:.1f} s, and no worker runs on any machine", now - world_->last_news), {});
  } else {
    look_for_workers(now, answers);
  }
}

/// A worker that dies while it starts may escape mpirun, which then waits for it without end. One that is stopped then
/// has no heartbeat yet that could tell.
void Membership::look_for_workers(double now, const std::vector<LookAnswer>& answers) {
  constexpr int enough_looks = 2;
  const auto missing = std::ranges::find(answers, false, &LookAnswer::has_worker);
  // mpirun starts all workers at once, but daemons on other machines take their time before that.
  const bool all_own =
      std::ranges::all_of(world_->ranks, [this](const Machine& machine) { return settings_.is_own(machine.address); });
  const bool have_begun = all_own || std::ranges::find(answers, true, &LookAnswer::has_worker) != answers.end();
  world_->looks_without_worker = missing != answers.end() && have_begun ? world_->looks_without_worker + 1 : 0;
  if (world_->looks_without_worker >= enough_looks) {
    world_->died_on = missing->machine;
    world_->killed = true;
    lose(fmt::format("no news for {:.1f} s, and the worker on {} is gone or stopped", now - world_->last_news,
                     missing->machine),
         {});
  }
}

void Membership::cleaned(double now, const std::vector<Unreached>& unreached) {
  if (!world_ || !world_->killing) {
    return;
  }
  for (const Unreached& machine : unreached) {
    unreachable_in_loss_ = true;
    world_->culprits.emplace(machine.machine, machine.words);
  }
  settle(now);
}

void Membership::settle(double now) {
  if (world_->end) {
    const EndMessage end = *world_->end;
    world_.reset();
    settle_end(now, end);
  } else {
    settle_loss(now);
  }
  decide(now);
}

void Membership::settle_loss(double now) {
  const World world = *std::exchange(world_, std::nullopt);
  for (const auto& [name, words] : world.culprits) {
    blame(now, name, words);
  }
  Host* host = find(world.died_on);
  if (host != nullptr && !world.culprits.contains(world.died_on)) {
    // Without another machine, to leave this one out would only be to wait.
    if (usable().size() > 1 && host->rank_died && now - *host->rank_died < settings_.timing.repeated_failure) {
      leave_out(now, *host, last_loss_);
    }
    host->rank_died = now;
  }
  if (!world.gained && !unreachable_in_loss_ && world.culprits.empty()) {
    settle_fruitless(now, world);
  }
}

/// A world has gained nothing, and no machine is to blame: when this goes on, the run is given up.
void Membership::settle_fruitless(double now, const World& world) {
  if (world.killed) {
    // Somebody, or a system without memory, kills again and again; it may be over soon.
    if (++fruitless_kills_ >= settings_.timing.fruitless_kills && !stop_asked_) {
      finish(Outcome::gave_up, 0,
             fmt::format("{} worlds in a row were killed without getting beyond step {}; the last one: {}",
                         fruitless_kills_, best_step_, last_loss_));
    } else if (fruitless_kills_ > 1) {
      not_before_ =
          now + doubled(settings_.timing.first_kill_wait, settings_.timing.longest_kill_wait, fruitless_kills_ - 2);
    }
    return;
  }
  ++fruitless_;
  fruitless_starts_ += world.started ? 0 : 1;
  if (fruitless_starts_ >= settings_.timing.fruitless_starts && !stop_asked_) {
    finish(Outcome::gave_up, 0,
           fmt::format("{} worlds in a row ended before they started, although all machines answer; the last one: {}",
                       fruitless_starts_, last_loss_));
  } else if (fruitless_ >= settings_.timing.fruitless_worlds && !stop_asked_) {
    finish(Outcome::gave_up, 0,
           fmt::format("{} worlds in a row were lost without getting beyond step {}; the last one: {}", fruitless_,
                       best_step_, last_loss_));
  }
}

void Membership::settle_end(double now, const EndMessage& end) {
  if (end.reason == "completed") {
    finish(Outcome::completed, 0, end.message);
  } else if (end.reason == "fault") {
    finish(Outcome::fault, end.exit_code, end.message);
  } else if (end.reason == "interrupted") {
    finish(Outcome::stopped, end.exit_code, end.message);
  } else if (end.reason == "output_error") {
    const Timing& timing = settings_.timing;
    const double wait = doubled(timing.first_output_wait, timing.longest_output_wait, output_failures_++);
    not_before_ = now + wait;
    tell(fmt::format("results cannot be written: {}; the run waits and tries again in {:.0f} s", end.message, wait));
  } else {
    apply_events(now, step_);
  }
}

void Membership::blame(double now, const std::string& name, const std::string& words) {
  if (Host* host = find(name)) {
    leave_out(now, *host, words);
  }
}

void Membership::leave_out(double now, Host& host, const std::string& words) {
  const double wait = doubled(settings_.timing.first_backoff, settings_.timing.longest_backoff, host.failures++);
  host.good = host.checking = false;
  host.left_out = true;
  host.retry_at = now + wait;
  host.reason = words;
  tell(fmt::format("{} is left out for {:.0f} s: {}", host.machine.name, wait, words));
}

void Membership::apply_events(double now, std::int64_t step) {
  for (StepEvent& event : settings_.events) {
    if (event.applied || event.step > step) {
      continue;
    }
    event.applied = true;
    tell(fmt::format("step {}: {} {}", step, event.add ? "add" : "remove", event.machine.name));
    if (event.add) {
      add_wanted(now, event.machine);
    } else if (!drop_wanted(event.machine.name)) {
      tell(fmt::format("{} is not one of the machines", event.machine.name));
    }
  }
}

void Membership::stop(double now) {
  if (finished_) {
    return;
  }
  const bool again = stop_asked_.has_value();
  stop_asked_ = stop_asked_.value_or(now);
  if (world_ && !world_->killing && !world_->end) {
    if (again) {
      lose("it is ended at once", {});
    } else {
      actions_.emplace_back(AskStop{});
    }
  }
  decide(now);
}

void Membership::tick(double now) { decide(now); }

void Membership::woke_up(double now) {
  if (world_) {
    const double silent = now - world_->last_news;
    news(now, false);
    world_->launched += silent;
    if (world_->connection_lost_at) {
      world_->connection_lost_at = now;
    }
  }
}

}  // namespace fexp::coordinator
