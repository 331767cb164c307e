// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/child_process.hpp"
#include "coordinator/control_server.hpp"
#include "coordinator/host_source.hpp"
#include "coordinator/membership.hpp"
#include "coordinator/probe_crew.hpp"
#include "coordinator/record.hpp"

namespace fexp::coordinator {

struct CoordinatorSettings {
  std::filesystem::path run;                                   ///< Directory of the run, absolute
  ClusterRecord record;                                        ///< Of the run so far
  std::vector<std::string> program;                            ///< This program, the same path on every machine
  std::vector<std::string> worker;                             ///< The program in front of "worker"
  std::function<void(const std::string&)> say;                 ///< A line for the user
  std::function<void(const std::string&)> note;                ///< Text for the log only
  std::function<void(const nlohmann::json& status)> progress;  ///< Every status of the worker
  std::function<int()> signal;                                 ///< Number of the signal that asks for the end, or 0
};

/// Starts worlds on the machines there are until the run has come to an end, and outlives every one of them. One
/// thread, which waits for sockets and programs; what to do is decided by Membership.
class Coordinator {
 public:
  /// Listens at the run's socket. Throws OutputError.
  explicit Coordinator(CoordinatorSettings settings);
  Coordinator(const Coordinator&) = delete;
  Coordinator& operator=(const Coordinator&) = delete;
  ~Coordinator();

  /// To the end of the run.
  [[nodiscard]] FinishRun run();
  /// What the last world had to say of the run, for the user; empty when it did not come to that.
  [[nodiscard]] const std::string& summary() const noexcept { return summary_; }
  /// Of the run as it is now, whether it could be written or not.
  [[nodiscard]] const ClusterRecord& record() const noexcept { return settings_.record; }

 private:
  // Events
  void look_around(double now);
  void receive(double now);
  void receive_message(double now, const ControlServer::Message& message);
  void greet(double now, int client, const nlohmann::json& hello);
  void note_threads(const nlohmann::json& status);
  void receive_from_world(double now, const nlohmann::json& message);
  [[nodiscard]] nlohmann::json answer_command(double now, const nlohmann::json& message);
  [[nodiscard]] nlohmann::json answer_add(double now, const std::string& text);
  [[nodiscard]] nlohmann::json answer_remove(double now, const std::string& name);
  [[nodiscard]] nlohmann::json status(double now) const;
  void look_at_launcher(double now);
  void collect_probes(double now);
  void collect_clean(double now);
  void look_for_machines(double now);

  // Actions
  void perform(double now);
  void launch(const LaunchWorld& world);
  void probe(ProbeCrew::Purpose purpose, const Machine& machine, double now, const std::vector<std::string>& more,
             double limit);
  void tell_world(const char* command);
  void clean_leftovers();
  void forget_everything();
  void close_world(const std::string& why);
  void save();
  void say(const std::string& text);
  void wait(int milliseconds);

  CoordinatorSettings settings_;
  Membership membership_;
  ControlServer server_;
  HostSource source_;
  ProbeCrew crew_;
  std::unique_ptr<ChildProcess> launcher_;
  std::optional<LaunchWorld> launched_;
  std::optional<int> world_client_;
  nlohmann::json worker_status_ = nlohmann::json::object();
  std::string end_reason_;  ///< Of the present world, once it has told
  std::string summary_;
  std::vector<LookAnswer> look_answers_;
  std::optional<KillWorld> killing_;
  double killed_at_{};
  bool cleaning_{};
  std::vector<Unreached> unreached_;
  std::map<std::string, Machine> used_;
  bool stop_pending_{};
  int signal_seen_{};
  std::string last_said_;
  std::optional<FinishRun> finish_;
  nlohmann::ordered_json saved_;
  bool save_failed_{};
};

}  // namespace fexp::coordinator
