// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/island_contact.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/constraints.hpp"
#include "solve/walls.hpp"
#include "solve/workspace.hpp"

namespace fexp::solve {

/// One epoch's work for an island.
struct EpochPlan {
  double dt{};  ///< [time]
  Index steps{};
  double end_time{};          ///< Of the last step, as the state's time will be set [time]
  std::int64_t hash_every{};  ///< Record body hashes after every so many steps of the run; 0: never.
  /// How far a body's nodes may move before it leaves its swept box [length], shape [bodies of the model].
  std::span<const double> allowance;
  double damping{};  ///< Coefficient of mass-proportional damping [1/time]
  bool stop{};       ///< The bodies are brought to rest before the first step.
};

struct HashRecord {
  std::int64_t step{};
  Index body{};
  std::uint64_t hash{};
};

/// Why an island stopped before its plan was done.
enum class StopReason { none, left_swept_box, not_finite };

struct IslandReport {
  Index steps_done{};
  StopReason stop{StopReason::none};
  Index stop_body{no_index};
  Index stop_node{no_index};      ///< For not_finite: the lowest node concerned.
  double contact_frequency2{};    ///< Largest bound of omega^2 from contact and walls seen [1/time^2]
  Index stiffest_node{no_index};  ///< Of the pair that has it
  Index stiffest_element{no_index};
  Index stiffest_wall{no_index};  ///< Instead of an element
  Index active_pairs{};           ///< At the last step
  Index most_active_pairs{};
  Index candidates{};
  Index searches{};
  double deepest{};  ///< Deepest penetration over contact distance seen [-]
  Index deepest_node{no_index};
  Index deepest_element{no_index};
};

/// Steps one island: bodies that may touch during an epoch, with the barriers near them. Islands share no mutable data,
/// so they can be stepped side by side. Allocates nothing inside a step except in a contact search.
class IslandSolver {
 public:
  /// Takes up an island. `bodies` and `barriers` are ascending; `patches`, which must outlive it, those of the model.
  void assign(const model::Model& model, const Patches& patches, const model::State& state,
              std::span<const Index> bodies, std::span<const Index> barriers);

  /// Forces, accelerations and external actions of the present state, without moving it: at the start of a run and
  /// after the state was put back or came from elsewhere. `time` is that of the state.
  void evaluate(const model::Model& model, model::State& state, Workspace& workspace);

  /// Has contact remember its forces, where an island takes up bodies whose forces are evaluated already.
  void recall(const model::Model& model, const model::State& state) { contact_.recall(model, state); }

  /// Takes plan.steps half-step central-difference steps [BLM00, box 6.1], or stops early for a reason.
  IslandReport advance(const model::Model& model, model::State& state, Workspace& workspace, const EpochPlan& plan,
                       std::vector<HashRecord>& hashes);

  /// Writes what only the island knows (contact sides and books) back to the state.
  void store(const model::Model& model, model::State& state) const {
    contact_.store_sides(model, state);
    contact_.store_books(state);
  }

  [[nodiscard]] std::span<const Index> bodies() const noexcept { return bodies_; }
  [[nodiscard]] std::span<const Index> barriers() const noexcept { return barriers_; }
  [[nodiscard]] Index element_count() const noexcept { return elements_; }

 private:
  /// The inner nodes of a patch or a part of a body's border: the unit of parallel work and of ordered sums.
  struct Piece {
    Index body{};
    Index patch{no_index};  ///< no_index: a part of the border
    const Index* node{};    ///< What `nodes` points into
    IndexRange nodes;
  };
  /// What one piece contributes to its body in a pass; summed in order.
  struct Partial {
    double largest_speed2{};
    bool finite{true};          ///< Velocities after the opening half step
    bool closing_finite{true};  ///< After the closing one
    double external_work{};
    double damping_work{};
    double barrier_energy{};
    double barrier_frequency2{};
    Index barrier_node{no_index};  ///< That has it
    Index barrier_wall{no_index};
    double wall_dissipation{};
    Vec3d force;
    Vec3d moment;
    Vec3d impulse;
    Vec3d angular_impulse;
    Vec3d rigid_force;    ///< All that acts on the nodes of a rigid body
    Vec3d rigid_moment;   ///< The same about its centre
    Vec3d rotation_rate;  ///< Of a rigid body inside the step
  };
  /// A rigid body of the island.
  struct RigidPart {
    Index rigid{};        ///< Into Model::rigid_bodies
    IndexRange pieces;    ///< Its own
    Vec3d rotation_rate;  ///< Inside the step [1/time]
  };
  /// A tied node of the island.
  struct IslandTie {
    Index tie{};        ///< Into Ties::ties
    Index body{};       ///< Of the node
    Index carrier{};    ///< The body that carries it
    std::size_t piece;  ///< The first one of the body whose sums its force goes to, where the carriers do not take it
    Vec3d place;        ///< Where it belongs at the end of the step, from its carriers where those deform
  };
  /// What follows the element forces. Where something acts from outside: accelerations, with the closing half step
  /// unless nodes are held that have to be seen to before. Elsewhere: both, and where the next step follows at once its
  /// opening half and motion, too.
  enum class Pass { accelerate, accelerate_and_close, close, close_and_open };

  struct Step;  // defined in solve/island_step.hpp

  void opening_half(const Step& step);
  void open_pieces(const Step& step);
  void clear_contact(const Step& step);
  void contact_forces(const Step& step);
  void load_nodes(const Step& step);
  void advance_pieces(const Step& step, Pass pass);
  void advance_patch(const Step& step, Pass pass, std::size_t piece);
  void advance_nodes(const Step& step, Pass pass, const NodeKernelArguments& arguments, std::size_t index);
  void accelerate(const Step& step, const NodeKernelArguments& k, std::size_t index);
  void move_walls(const Step& step);
  void follow_walls(const Step& step);
  [[nodiscard]] double half_work_of_walls(const BodyActions& actions) const;
  void push_wall(const Step& step, Index body, std::size_t piece);
  void join_by_walls(const Step& step);
  void clear_actions(const Step& step, std::size_t index);
  NodalAction act_on_node(const Step& step, Index n, std::size_t index);
  void act_on_bodies(const Step& step);
  void close(const Step& step, std::size_t piece);
  void close_pieces(const Step& step);
  void book_closing_half(const Step& step);
  static void move(const Step& step, const Piece& piece, Partial& partial);
  static void kick(const Step& step, const Piece& piece, Partial& partial);
  void prescribe(const Step& step, HalfStep half);
  [[nodiscard]] bool is_rigid(const Step& step, std::size_t piece) const;
  template <class Visit>
  void for_each_rigid(const Visit& visit);
  template <class Visit>
  void for_each_rigid_piece(const Visit& visit);
  void open_rigid(const Step& step);
  void place_rigid_nodes(const Step& step, std::size_t index);
  void sum_rigid_pieces(const Step& step);
  void sum_rigid_piece(const Step& step, std::size_t index);
  void accelerate_rigid(const Step& step);
  void close_rigid(const Step& step);
  void rate_rigid_nodes(const Step& step);
  void finish_rigid(const Step& step, bool go_on);
  void evaluate(const Step& still);
  void assign_ties(const model::Model& model, const model::State& state);
  void carry_ties(const Step& step);
  static void book_tie(const Step& step, const IslandTie& of_island, double power);
  void take_up_masses(const Step& step) const;
  void break_ties(const Step& step, double start_time);
  [[nodiscard]] double kept_energy(const Step& step, std::size_t piece) const;
  void steer_ties(const Step& step);
  void place_ties(const Step& step);
  void rate_ties(const Step& step) const;
  [[nodiscard]] NodeKernelArguments node_arguments(const Step& step, Pass pass) const;
  [[nodiscard]] bool check_opened(const Step& step, IslandReport& report) const;
  [[nodiscard]] bool check_closed(const Step& step, IslandReport& report) const;
  [[nodiscard]] bool find_broken(const Step& step, IslandReport& report) const;
  [[nodiscard]] bool check_motion(const Step& step, const EpochPlan& plan, IslandReport& report);
  void record_hashes(const Step& step, std::int64_t number, std::vector<HashRecord>& hashes) const;

  contact::IslandContact contact_;
  std::vector<Index> bodies_;
  std::vector<Index> barriers_;
  std::vector<Piece> pieces_;         // In order of bodies, of each the patches first
  std::vector<Index> patch_pieces_;   // Those that are patches
  std::vector<Index> border_pieces_;  // The others
  std::vector<Index> rigid_pieces_;   // Those of rigid bodies, in none of the two lists above
  std::vector<RigidPart> rigid_;      // Rigid bodies
  std::vector<IslandTie> ties_;       // Of its bodies' nodes that hold, ascending
  std::vector<double> kept_;          // [pieces]: energy before ties break, and its change
  std::vector<Partial> partials_;     // [pieces]
  std::vector<Vec3d> wall_partials_;  // [pieces][walls]: forces
  std::vector<WallTouch> touches_;    // [pieces][walls]: of walls with mass
  std::vector<Index> walls_;          // That act on the island: those that move as told, and its own
  std::vector<Index> own_walls_;      // With mass, among its bodies
  std::vector<Vec3d> wall_points_;    // [walls]: at the end of the step
  std::vector<Vec3d> wall_ways_;      // [walls]: in the step
  std::vector<double> travelled_;     // [bodies of the island]: bound of the distance since the epoch's start
  contact::ContactReport contact_report_;
  double barrier_frequency2_{};
  Index barrier_node_{no_index};
  Index barrier_wall_{no_index};
  Index elements_{};
  Index nodes_{};
  Index rigid_nodes_{};
  double inertia_ratio_{1.0};  // Largest of the rigid bodies and at ties
  bool contact_written_{};
  bool held_{};       // Nodes of the island are held, prescribed or tied
  bool can_break_{};  // Ties of the island have a strength
  bool prescribed_{};
};

}  // namespace fexp::solve
