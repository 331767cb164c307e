// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/membership.hpp"

namespace fexp::coordinator {

/// A membership with a clock, and what it wanted done.
struct Scene {
  explicit Scene(std::vector<StepEvent> events = {}, Timing timing = {})
      : membership(
            {"1.0", [](std::string_view address) { return address == "localhost"; }, std::move(events), 1, timing}) {}

  /// Takes actions; checks of machines are answered with `answer`, or as their machine's entry in `answers`.
  void settle() {
    for (auto actions = membership.take_actions(); !actions.empty(); actions = membership.take_actions()) {
      for (const Action& action : actions) {
        note(action);
      }
    }
  }

  void note(const Action& action) {
    if (const auto* check = std::get_if<CheckMachine>(&action)) {
      checks.push_back(*check);
      if (answer_checks) {
        const bool down = std::ranges::find(dead, check->machine.name) != dead.end();
        membership.checked(now, check->machine, down ? CheckAnswer{false, "no route", "", false} : good);
      }
    } else if (const auto* launch = std::get_if<LaunchWorld>(&action)) {
      launches.push_back(*launch);
    } else if (const auto* look = std::get_if<LookAt>(&action)) {
      looks.push_back(*look);
    } else if (const auto* kill = std::get_if<KillWorld>(&action)) {
      kills.push_back(*kill);
    } else if (const auto* finish = std::get_if<FinishRun>(&action)) {
      finished = *finish;
    } else if (const auto* words = std::get_if<Tell>(&action)) {
      told += words->text + "\n";
    } else if (std::holds_alternative<AskReform>(action)) {
      ++reforms;
    } else {
      ++stops;
    }
  }

  void want(const std::string& name, const std::string& address) {
    membership.want(now, {name, address, 0});
    settle();
  }
  /// Lets time pass, ten ticks a second.
  void pass(double seconds) {
    const double begin = now;
    for (long tick = 1; tick <= std::lround(10.0 * seconds); ++tick) {
      now = begin + 0.1 * static_cast<double>(tick);
      membership.tick(now);
      settle();
    }
  }
  void start(std::int64_t step = 0) {
    membership.connected(now);
    membership.started(now, step);
    settle();
  }
  void advance(std::int64_t step) {
    membership.advanced(now, step);
    settle();
  }
  void end(const std::string& reason, std::optional<std::int64_t> step = {}) {
    membership.ended(now, {reason, 0, reason, step});
    membership.launcher_exited(now, "", {});
    settle();
  }
  void die(std::optional<int> rank, const std::vector<Unreached>& unreached = {}) {
    membership.launcher_exited(now, "it died", rank);
    settle();
    membership.cleaned(now, unreached);
    settle();
  }
  void look(const std::vector<LookAnswer>& answers) {
    membership.looked(now, answers);
    settle();
  }
  void clean() {
    membership.cleaned(now, {});
    settle();
  }
  /// Names by rank of the last world.
  [[nodiscard]] std::vector<std::string> ranks() const {
    std::vector<std::string> names;
    for (const Machine& machine : launches.back().ranks) {
      names.push_back(machine.name);
    }
    return names;
  }
  [[nodiscard]] std::string state(const std::string& name) const {
    for (const auto& view : membership.machines(now)) {
      if (view.machine.name == name) {
        return view.state;
      }
    }
    return "unknown";
  }

  Membership membership;
  double now{1000.0};
  bool answer_checks{true};
  CheckAnswer good{true, "", "1.0", true};
  std::vector<std::string> dead;
  std::vector<CheckMachine> checks;
  std::vector<LaunchWorld> launches;
  std::vector<LookAt> looks;
  std::vector<KillWorld> kills;
  std::optional<FinishRun> finished;
  std::string told;
  int reforms{};
  int stops{};
};

using Names = std::vector<std::string>;

/// Three machines, this one in the middle, and their world is stepping.
inline Scene three() {
  Scene scene;
  scene.answer_checks = false;
  scene.want("a", "far1");
  scene.want("here", "localhost");
  scene.want("b", "far2");
  for (const CheckMachine& check : std::vector(scene.checks)) {
    scene.membership.checked(scene.now, check.machine, scene.good);
  }
  scene.answer_checks = true;
  scene.settle();
  scene.start();
  scene.advance(10);
  return scene;
}

}  // namespace fexp::coordinator
