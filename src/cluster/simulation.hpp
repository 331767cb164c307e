// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cluster/body_notice.hpp"
#include "cluster/communicator.hpp"
#include "cluster/epoch_report.hpp"
#include "cluster/interaction_graph.hpp"
#include "cluster/placement.hpp"
#include "cluster/placement_ledger.hpp"
#include "cluster/rank_record.hpp"
#include "cluster/watchdog.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/diagnostics.hpp"
#include "solve/island_solver.hpp"
#include "solve/workspace.hpp"

namespace fexp::cluster {

/// Who takes part in a run: this rank's communicator and the machines, the same list on every rank.
struct World {
  std::shared_ptr<Communicator> communicator;
  std::vector<Machine> machines;
  PlacementRule rule{PlacementRule::fewest_elements};

  /// One machine, one rank.
  [[nodiscard]] static World alone();
};

/// How the work went since this world began.
struct WorldLoad {
  std::vector<double> busy_seconds;  ///< Spent stepping, shape [machines]
  std::vector<int> running_threads;  ///< Of the processes, computing or not, shape [machines]
  double waiting_seconds{};          ///< Spent in the communicator, mean of the ranks
  double seconds{};                  ///< In all
  std::int64_t epochs{};
  std::int64_t messages{};  ///< Of all ranks
  std::int64_t message_bytes{};
  BalanceReport balance;  ///< From the measured cost of the present islands
};

/// Integrates a model epoch by epoch on the machines of a world. At an epoch's start the swept boxes of all bodies give
/// the interaction graph, its components are the islands, each island lives on one machine, and the islands are stepped
/// side by side without a word between machines. A guard checks afterwards that no body left its swept box and that the
/// step was stable; where it trips, the epoch is put back to its start and redone shorter or with a smaller step.
///
/// Every rank has the whole model and room for the whole state, of which only the bodies of its own machine are up to
/// date. What is decided is decided by all ranks alike, from what all of them know. All ranks call the same functions
/// with the same arguments, unless a comment says otherwise.
class Simulation {
 public:
  Simulation(const model::Model& model, solve::KernelChoice kernel, World world = World::alone());
  /// Takes up a run where pieces of a snapshot have it, on whatever machines there are now. Every rank gives the pieces
  /// that it holds; together they hold every body once at least, of one moment. Throws ShipmentError when they do not.
  Simulation(const model::Model& model, solve::KernelChoice kernel, World world, std::span<const Bytes> pieces);

  /// Steps until `target` time or the end of one epoch, whichever comes first. `hash_every`: see EpochPlan. `requests`:
  /// this rank's own; those of all ranks are in the report.
  EpochReport run_epoch(double target, std::int64_t hash_every = 0, const Requests& requests = {});

  [[nodiscard]] const model::Model& model() const noexcept { return model_; }
  /// Time and step, and the bodies of this machine; after collect() on rank 0 those that were collected too.
  [[nodiscard]] const model::State& state() const noexcept { return state_; }
  [[nodiscard]] const solve::Workspace& workspace() const noexcept { return workspace_; }
  [[nodiscard]] const RunExtremes& extremes() const noexcept { return extremes_; }
  [[nodiscard]] const solve::Diagnostics& start() const noexcept { return start_; }
  /// How far a static analysis has come.
  [[nodiscard]] const Relaxation& relaxation() const noexcept { return relaxation_; }
  [[nodiscard]] const Watchdog& watchdog() const noexcept { return watchdog_; }
  /// Diagnostics, errors and contact counts of the present state.
  [[nodiscard]] EpochReport present() const;
  /// Island of each body (barriers: no_index), shape [bodies].
  [[nodiscard]] const std::vector<Index>& island_of_body() const noexcept { return island_of_body_; }

  /// Brings the states and contact forces of bodies to rank 0, ascending; without a list those of all bodies.
  void collect(std::span<const Index> bodies);
  void collect();
  /// The state at the start of the last epoch: the bodies of this machine, and on rank 0 all of them after
  /// collect_epoch_start().
  [[nodiscard]] const model::State& epoch_start() const noexcept { return backup_; }
  void collect_epoch_start();

  [[nodiscard]] const World& world() const noexcept { return world_; }
  [[nodiscard]] int rank() const noexcept { return world_.communicator->rank(); }
  /// Machine of each body (barriers: no_machine), shape [bodies].
  [[nodiscard]] const std::vector<MachineIndex>& owner() const noexcept { return owner_; }
  [[nodiscard]] PlacementLedger& ledger() noexcept { return ledger_; }
  [[nodiscard]] const PlacementLedger& ledger() const noexcept { return ledger_; }
  [[nodiscard]] WorldLoad load() const;
  /// Bodies of this rank's machine, ascending.
  [[nodiscard]] const std::vector<Index>& own_bodies() const noexcept { return own_bodies_; }

  /// The state of the bodies, which this rank must have, and all that a run needs besides: taken up again by the second
  /// constructor, on any rank of any world.
  [[nodiscard]] Bytes piece(std::span<const Index> bodies) const;

 private:
  struct Attempt;
  struct Blank {};

  Simulation(const model::Model& model, solve::KernelChoice kernel, World world, Blank);

  enum class Verdict { accept, redo, give_up };

  void attempt_epoch(double target, std::int64_t hash_every, const Requests& requests, EpochReport& report);
  void plan(double target, Attempt& attempt) const;
  void form_islands(const Attempt& attempt);
  void place(const std::vector<Island>& islands);
  void move_bodies(const std::vector<MachineIndex>& owner);
  void take_up_solvers(std::vector<Island> islands);
  void find_own_bodies();
  RankRecord advance_islands(const Attempt& attempt, std::int64_t hash_every, const Requests& requests,
                             EpochReport& report);
  RankRecord share(const RankRecord& own, std::span<const double> island_seconds);
  void take_in(std::span<const std::size_t> islands, ByteReader& in);
  void scale_cost(std::span<const std::size_t> islands, double cost);
  void share_hashes(EpochReport& report);
  Verdict guard(Attempt& attempt, const RankRecord& record, bool may_retry, Fault& fault);
  void put_back();
  void gather(const RankRecord& record, EpochReport& report) const;
  void relax(double dt);
  void judge(EpochReport& report);
  void adopt_machines(const std::vector<Machine>& known);
  void unpack_run(ByteReader& in);
  void read_piece(std::span<const std::byte> piece, Bytes& run, std::vector<Index>& held);
  [[nodiscard]] std::vector<int> learn_holders(const std::vector<Index>& held, Bytes& run);
  void place_the_homeless();
  void begin_load();
  void pack_run(ByteWriter& out) const;

  [[nodiscard]] int rank_of(Index body) const;
  [[nodiscard]] bool is_own(Index body) const { return rank_of(body) == rank(); }
  [[nodiscard]] solve::CriticalStep smallest_critical_step() const;
  [[nodiscard]] solve::Diagnostics sum_of_diagnostics() const;
  [[nodiscard]] static std::vector<double> elements_of(const model::Model& model);
  [[nodiscard]] bool may_halve() const;
  [[nodiscard]] bool is_curable(const EpochReport& report) const;
  void describe(EpochReport& report);
  void describe_break(Fault& fault) const;
  void describe_collapse(const EpochReport& report, Fault& fault) const;
  void describe_drift(const EpochReport& report, Fault& fault) const;
  void add_history(Fault& fault) const;

  const model::Model& model_;
  std::uint64_t fingerprint_;  ///< Of the model, in snapshots
  World world_;
  model::State state_;
  model::State backup_;
  solve::Workspace workspace_;
  std::vector<BodyNotice> notices_;        // [bodies]
  std::vector<BodyNotice> start_notices_;  // [bodies]: of the epoch's start
  std::vector<MachineIndex> owner_;        // [bodies]
  std::vector<Index> own_bodies_;
  std::vector<bool> arrived_;    // [bodies]: came from elsewhere, so that their forces are to be evaluated
  std::vector<Island> islands_;  ///< Of all machines
  std::vector<std::unique_ptr<solve::IslandSolver>> solvers_;  // [islands]: of this machine's; others null
  std::vector<Index> island_of_body_;
  std::vector<double> island_cost_;  // [islands]: time of the last epoch on one machine of speed 1 [s]
  PlacementLedger ledger_;
  WorldLoad load_;
  std::chrono::steady_clock::time_point began_;
  Traffic told_;                  ///< Traffic that other ranks know of
  std::int64_t moved_bytes_{};    ///< Not told yet
  std::string pending_reason_;    ///< Of the next placement, besides what the islands do
  solve::CriticalStep critical_;  ///< Of the elements in the present state
  double contact_frequency2_{};   ///< Contact's share of omega^2 in the last epoch [1/time^2]
  solve::Diagnostics start_;
  double energy_scale_{};
  double loads_end_{};      // Of a static analysis: when loads change no more [time]
  double sudden_energy_{};  // Open because of loads that come at once [force*length]
  Relaxation relaxation_;   // Of a static analysis
  double linear_scale_{};
  double angular_scale_{};
  double step_before_{};          // Critical step of elements and contact together at the epoch's start [time]
  double half_until_{-HUGE_VAL};  // Epochs that begin before this time take half the step [time]
  Watchdog watchdog_;
  RunExtremes extremes_;
};

}  // namespace fexp::cluster
