// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "coordinator/machine.hpp"

namespace fexp::coordinator {

/// How a run ended for the coordinator.
enum class Outcome { completed, fault, stopped, gave_up };

/// A change of the cluster at a step of the run: the world ends at the first boundary of epochs at or after it.
struct StepEvent {
  std::int64_t step{};
  bool add{};  ///< Or remove
  Machine machine;
  bool applied{};
};

/// What a machine answered before it is used, or used again.
struct CheckAnswer {
  bool reached{};
  std::string words;  ///< Why it was not reached, the launch agent's own words
  std::string version;
  bool has_mpi{};
};

/// What a machine of a world that seems to stand still answered.
struct LookAnswer {
  std::string machine;
  bool reached{};
  std::string words;                    ///< Why it was not reached
  std::optional<double> heartbeat_age;  ///< [s]; none when its worker has not begun
  bool has_worker{true};                ///< A process of it is there and not stopped
};

/// A machine that could not be reached.
struct Unreached {
  std::string machine;
  std::string words;
};

/// What rank 0 said before it left.
struct EndMessage {
  std::string reason;  ///< One of those of ControlClient
  int exit_code{};
  std::string message;
  std::optional<std::int64_t> step;
};

// What is to be done.

/// Ask a machine what it is, and end workers of worlds below this one on it.
struct CheckMachine {
  Machine machine;
  int below{};
};
/// Ask these machines how old their heartbeats are.
struct LookAt {
  std::vector<Machine> machines;
};
struct LaunchWorld {
  int world{};
  std::vector<Machine> ranks;  ///< By rank; rank 0 is on this machine
  bool writer_only{};          ///< Rank 0 computes nothing
};
/// Tell rank 0 to end the world for a new one.
struct AskReform {};
/// Tell rank 0 to end the run.
struct AskStop {};
/// End mpirun, and the world's workers on the machines that can be reached.
struct KillWorld {
  int world{};
  std::vector<Machine> machines;
};
struct FinishRun {
  Outcome outcome{};
  int exit_code{};  ///< The worker's; 0 when it told none
  std::string message;
};
/// Say something to the user.
struct Tell {
  std::string text;
};
using Action = std::variant<CheckMachine, LookAt, LaunchWorld, AskReform, AskStop, KillWorld, FinishRun, Tell>;

/// Name of the machine of a rank 0 that only writes; no name that a user can give.
inline constexpr const char* writer_name = "_writer";

/// How long things may take [s].
struct Timing {
  double shortest_stall{3.0};     ///< Without news of a world for so long, its machines are looked at,
  double stall_gaps{10.0};        ///< or for so many times the longest gap between two of its news.
  double stale_heartbeat{2.0};    ///< Older than this while others are fresh: frozen
  double all_stale{10.0};         ///< All older than this: nothing moves at all
  double launch{60.0};            ///< From mpirun's start to a word of rank 0
  double load{900.0};             ///< From there to "started"
  double patience{120.0};         ///< Longest without news when all machines look well,
  double patience_gaps{100.0};    ///< or so many times the longest gap
  double leave{5.0};              ///< From "ended", or a lost rank 0, to mpirun's end
  double stop{30.0};              ///< From being asked to stop to the end
  double first_backoff{10.0};     ///< A machine that failed is left out so long, then twice as long ...
  double longest_backoff{600.0};  ///< and so long at most
  double repeated_failure{60.0};  ///< Two deaths of a rank within this: the machine is left out
  double good_conduct{300.0};     ///< After so long without failure its failures are forgotten
  double first_output_wait{5.0};  ///< After an error of output, then twice as long ...
  double longest_output_wait{60.0};
  int fruitless_starts{3};      ///< Worlds in a row that die before they start: give up
  int fruitless_worlds{6};      ///< Worlds in a row that gain no step: give up
  int fruitless_kills{12};      ///< Worlds in a row that are killed from outside and gain no step: give up
  double first_kill_wait{0.1};  ///< After the second one of these, then twice as long ...
  double longest_kill_wait{30.0};
};

/// Decides which machines make up the cluster, when a world ends and a new one begins, and who is to blame when one is
/// lost. Events go in, each with the time [s since any moment], and actions come out; nothing else happens here.
class Membership {
 public:
  struct Settings {
    std::string version;                           ///< Of fexp here; a machine with another is not used
    std::function<bool(std::string_view)> is_own;  ///< Whether an address means this machine
    std::vector<StepEvent> events;
    int first_world{1};
    Timing timing;
  };

  explicit Membership(Settings settings);

  // Machines asked for and no longer asked for.
  void want(double now, const Machine& machine);
  /// False when no such machine is wanted.
  bool unwant(double now, std::string_view name);

  // Answers to actions.
  void checked(double now, const Machine& machine, const CheckAnswer& answer);
  void looked(double now, const std::vector<LookAnswer>& answers);
  void cleaned(double now, const std::vector<Unreached>& unreached);

  // News of the world.
  void connected(double now);
  void started(double now, std::int64_t step);
  void advanced(double now, std::int64_t step);
  void ended(double now, const EndMessage& message);
  void connection_lost(double now);
  /// mpirun is gone; `words` on why, the rank that failed if it said so, and whether it or mpirun was killed from
  /// outside, for which neither the run nor a machine can be blamed at once.
  void launcher_exited(double now, const std::string& words, std::optional<int> failed_rank, bool killed = false);

  /// The first call ends the run in order, the second at once.
  void stop(double now);
  /// Time has passed. To be called several times a second.
  void tick(double now);
  /// This process did not run for a while: silence since then means nothing.
  void woke_up(double now);

  /// What is to be done since the last call, in this order.
  [[nodiscard]] std::vector<Action> take_actions();

  struct MachineView {
    Machine machine;
    std::string state;               ///< "computing", "leaving", "ready", "being checked" or "left out"
    std::string reason;              ///< Why it is left out
    std::optional<double> retry_in;  ///< [s]
  };
  [[nodiscard]] std::vector<MachineView> machines(double now) const;
  [[nodiscard]] std::vector<Machine> wanted() const;
  [[nodiscard]] const std::vector<StepEvent>& events() const noexcept { return settings_.events; }
  /// Steps of the events to come, ascending.
  [[nodiscard]] std::vector<std::int64_t> event_steps() const;
  /// "starting", "running", "re-forming", "cleaning up", "waiting" or "finished"
  [[nodiscard]] std::string phase() const;
  [[nodiscard]] std::optional<int> world() const;
  [[nodiscard]] std::int64_t step() const noexcept { return step_; }
  /// Why the last world that was lost was.
  [[nodiscard]] const std::string& last_loss() const noexcept { return last_loss_; }

 private:
  struct Host {
    Machine machine;
    bool wanted{true};
    bool checking{};
    bool good{};      ///< Checked, and not failed since
    bool left_out{};  ///< Failed; tried again at retry_at
    int failures{};
    double retry_at{};
    double good_since{};
    std::optional<double> rank_died;
    std::string reason;
  };
  struct World {
    int number{};
    std::vector<Machine> ranks;
    std::vector<Machine> computing;
    bool connected{}, started{}, reform_asked{}, killing{};
    double launched{}, last_news{}, longest_gap{}, next_look{};
    std::optional<double> looking_since, connection_lost_at, ended_at;
    std::optional<EndMessage> end;
    std::map<std::string, std::string> culprits;  ///< Machine -> what is wrong with it
    std::string died_on;                          ///< Machine of the rank that died
    int looks_without_worker{};                   ///< In a row, at a world of which some worker is missing
    bool gained{}, killed{};
  };

  void add_wanted(double now, const Machine& machine);
  bool drop_wanted(std::string_view name);
  void decide(double now);
  void check_machines(double now);
  void launch(double now);
  void watch(double now);
  void news(double now, bool counts_as_gap);
  void apply_events(double now, std::int64_t step);
  void look_for_workers(double now, const std::vector<LookAnswer>& answers);
  void lose(const std::string& words, const std::vector<std::string>& unreachable);
  void settle(double now);
  void settle_loss(double now);
  void settle_fruitless(double now, const World& world);
  void settle_end(double now, const EndMessage& end);
  void blame(double now, const std::string& name, const std::string& words);
  void leave_out(double now, Host& host, const std::string& words);
  void forget_unwanted();
  void finish(Outcome outcome, int exit_code, const std::string& message);
  void tell(std::string text) { actions_.emplace_back(Tell{std::move(text)}); }
  [[nodiscard]] Host* find(std::string_view name);
  [[nodiscard]] std::vector<Machine> usable() const;
  [[nodiscard]] bool waits_for_checks() const;
  [[nodiscard]] bool computes(std::string_view name) const;

  Settings settings_;
  std::vector<Host> hosts_;
  std::optional<World> world_;
  int next_world_;
  std::int64_t step_{};
  std::int64_t best_step_{};
  int fruitless_{};
  int fruitless_starts_{};
  int fruitless_kills_{};
  int output_failures_{};
  bool unreachable_in_loss_{};
  double not_before_{};
  std::optional<double> stop_asked_;
  bool finished_{};
  bool told_nobody_{};
  std::string last_loss_;
  std::vector<Action> actions_;
};

}  // namespace fexp::coordinator
