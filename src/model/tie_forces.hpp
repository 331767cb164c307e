// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"

/// What ties transmit, from the state at a step boundary.
namespace fexp::model {

/// The force of a tied node on its carriers, and its parts by the triangle's normal.
struct TieForce {
  Vec3d force;      ///< [force]
  Vec3d moment;     ///< About the node [force*length]
  double normal{};  ///< Along the normal that points to the node: > 0 pulls them apart [force]
  double shear{};   ///< Size of what is left [force]
};

/// What acts on the node less what moves its mass, F - m a: the carriers have the mass, but the joint moves it. `time`:
/// that of the state, which says how carriers move that are told to [time]. Where the node is on the very triangle
/// there is no side to be pulled to, and both directions count as pulling.
[[nodiscard]] TieForce tie_force(const Model& model, const State& state, double time, Index number);

/// Whether (max(0, normal)/its strength)^2 + (shear/its strength)^2 >= 1, the criterion of LS-DYNA's tiebreak contact
/// (option 2) without its exponents to choose.
[[nodiscard]] bool is_beyond_strength(const Model& model, const State& state, double time, Index number);

/// Sums over the ties of a table of the deck.
struct TieResultant {
  Vec3d force;      ///< On the carriers [force]
  Vec3d moment;     ///< About the mean place of all its nodes, tied or not any more [force*length]
  double normal{};  ///< Sum of the normal parts [force]
  double shear{};   ///< Sum of the sizes of the shear parts [force]
};

/// In the order of the nodes. `description` is the table's number. Nodes of bodies that are held altogether count
/// nothing, as nothing is evaluated there.
[[nodiscard]] TieResultant tie_resultant(const Model& model, const State& state, Index description);

/// Nodes of the table that are tied no more.
[[nodiscard]] std::int64_t broken_ties(const Model& model, const State& state, Index description);

}  // namespace fexp::model
