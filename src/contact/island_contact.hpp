// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/block_pairs.hpp"
#include "contact/block_wear.hpp"
#include "contact/candidates.hpp"
#include "contact/edge_search.hpp"
#include "contact/edge_watch.hpp"
#include "contact/node_watch.hpp"
#include "contact/pair_books.hpp"
#include "contact/watched_rows.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::contact {

/// Sums of contact over one body at one instant.
struct BodyContact {
  double energy{};       ///< Potential of the pairs booked to the body [force*length]
  double dissipated{};   ///< What these have dissipated in the step [force*length]
  double work{};         ///< Of all contact forces on the body in the step [force*length]
  Vec3d barrier_force;   ///< Force of barriers on the body [force]
  Vec3d barrier_moment;  ///< The same about the origin [force*length]
};

/// Contact forces on the nodes of a model; each island writes its own bodies' part, barriers get nothing.
struct NodeContact {
  std::vector<Vec3d> force;       // [nodes] [force]
  std::vector<double> stiffness;  // [nodes]: sum over pairs of k x weight, more by damping [force/length]
};

struct ContactReport {
  Index active_pairs{};  ///< Pairs with a force
  Index candidates{};    ///< Pairs that are watched
  Index searches{};      ///< Since the island was taken up
  double deepest{};      ///< Deepest penetration over contact distance [-]
  Index deepest_node{no_index};
  Index deepest_element{no_index};
  double max_stiffness_over_mass{};  ///< Bound of contact's share of omega^2 [1/time^2]
  Index stiffest_node{no_index};     ///< Of the pair that has it, an end where edges touch
  Index stiffest_element{no_index};
};

/// Contact inside one island: of its bodies with each other, with themselves and with the barriers near them. A pair
/// belongs to the body of its node, or to that of its element when the node is a barrier's; a pair of edges to that of
/// the first, or of the second when the first is a barrier's.
class IslandContact {
 public:
  /// Takes up an island, with the sides that the state remembers. `bodies` and `barriers` are ascending.
  void assign(const model::Model& model, std::span<const Index> bodies, std::span<const Index> barriers,
              const model::State& state);

  /// Books the work of the present forces over half the way of a step, of which the state has the velocities: to be
  /// called when nodes have moved, before `advance`. With its new forces `evaluate` books the other half.
  void book_half_work(const model::Model& model, const model::State& state, double dt, BodyContact* bodies);

  /// To be called when nodes have moved, none by more than `largest_way` [length]. Searches when that is needed.
  void advance(const model::Model& model, const model::State& state, double largest_way);

  /// Forces at the present positions, added to those in `nodes`; sums per body, added to those in `bodies`, shape
  /// [bodies of the model]. `dt`: the step that has led here; 0 where nothing has moved.
  ContactReport evaluate(const model::Model& model, const model::State& state, double dt, NodeContact& nodes,
                         BodyContact* bodies);

  /// Evaluates the forces of a state that an island with other bodies has left, without writing them anywhere: their
  /// work in the first half of the next step is booked pair by pair.
  void recall(const model::Model& model, const model::State& state);

  /// Writes the remembered sides of all pairs to the state of the bodies they belong to.
  void store_sides(const model::Model& model, model::State& state) const;
  /// Likewise the books.
  void store_books(model::State& state) const { books_.store(bodies_, state); }

 private:
  void search_all(const model::Model& model, const Positions& x);
  void search_worn(const model::Model& model, const Positions& x);
  void search(const model::Model& model, const Positions& x);
  void look(const model::Model& model, const Positions& now, const Positions& before);
  void add(const model::Model& model, const Positions& x, const ActivePair& pair, NodeContact& nodes,
           BodyContact* bodies);
  void add(const model::Model& model, const Positions& x, const ActiveEdges& pair, NodeContact& nodes,
           BodyContact* bodies);
  void find_stiffest(const model::Model& model, const NodeContact& nodes);
  void count(double stiffness, double depth, Index node, Index element);
  [[nodiscard]] static Index owner(const model::Model& model, Index node, Index element);

  BlockPairs blocks_;
  BlockWear wear_;
  CandidateSearch node_search_;
  EdgeSearch edge_search_;
  WatchedRows<model::ContactSide, ActivePair> nodes_;
  WatchedRows<model::EdgeSide, ActiveEdges> edges_;
  PairBooks books_;
  std::vector<Index> bodies_;
  double skin_{};
  double margin_{};       ///< More, up to which blocks are partners [length]
  double way_{};          ///< Bound of the relative motion of any two nodes since wear was measured [length]
  double most_way_{};     ///< What it may come to before wear must be measured [length]
  double moved_{};        ///< The same of two nodes near each other since candidates were listed, less way_ [length]
  double travelled_{};    ///< The same of any two nodes since candidates were listed [length]
  double rounded_way_{};  ///< Bound of what rounding adds to a node's way in a step [length]
  bool enabled_{};
  bool with_edges_{};
  bool searched_{};
  ContactReport report_;
};

}  // namespace fexp::contact
