// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned_vector.hpp"
#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/rigid_motion.hpp"

namespace fexp::model {

/// Motion of one node, kept in one record because elements and contact gather all of it together.
struct NodeMotion {
  Vec3d position;       ///< x [length]
  Vec3d velocity;       ///< v [length/time]; at t(n) between steps, at t(n+1/2) inside a step
  Vec3d rotation_rate;  ///< omega [1/time], likewise
};

struct NodeAcceleration {
  Vec3d linear;   ///< a [length/time^2]
  Vec3d angular;  ///< alpha [1/time^2]
};

/// Rows of the element history; storage is [block][row][lane].
enum ElementRow : Index {
  row_nxx,
  row_nyy,
  row_nxy,  // membrane resultants N [force/length], element frame
  row_mxx,
  row_myy,
  row_mxy,  // bending resultants M [force]
  row_qxz,
  row_qyz,  // transverse shear resultants Q [force/length]
  row_drill_1,
  row_drill_2,
  row_drill_3,  // relative drilling rotation of the corners [-]
  row_energy,   // internal energy of the element [force*length]
  element_rows
};

/// Side of a triangle on which a node belongs, remembered while they are near each other: +1 where the triangle's
/// normal points, -1 behind.
struct ContactSide {
  Index node{};
  Index element{};
  std::int8_t side{};
  Vec3d drag{};  ///< Friction and damping on the node at the last step [force]

  friend bool operator==(const ContactSide&, const ContactSide&) = default;
};

/// Side on which one edge belongs of another one, remembered while they cross near each other: +1 where the first edge
/// x the second edge points from the first to the second, -1 on the other side. An edge's number is 3 x element + its
/// number there, of the lower of the elements that share it; it leads from corner a to corner a + 1.
struct EdgeSide {
  Index first{};
  Index second{};  ///< The higher number
  std::int8_t side{};
  Vec3d drag{};  ///< On the second edge [force]

  friend bool operator==(const EdgeSide&, const EdgeSide&) = default;
};

/// Quantities of one body that are integrated over the run or belong to the last evaluated forces.
struct BodyLedger {
  double external_work{};            ///< Loads, gravity and prescribed motion [force*length], integrated
  double damping_work{};             ///< Work taken out by damping (>= 0) [force*length], integrated
  double contact_energy{};           ///< Potential of the pairs that are booked to this body [force*length]
  double contact_dissipation{};      ///< Taken by friction and damping of contact (>= 0) [force*length], integrated
  double wall_dissipation{};         ///< And of rigid walls
  double barrier_energy{};           ///< Potential of rigid walls, with that of sticking to them [force*length]
  double contact_work{};             ///< Of contact forces on this body [force*length], integrated
  Vec3d external_impulse{};          ///< Loads, walls, damping and constraints [force*time], integrated
  Vec3d external_angular_impulse{};  ///< The same about the origin [force*length*time], integrated
};

/// Books of the contact between two bodies, or of a body with itself. The lower one keeps them, or the other where that
/// is a barrier. Works are those of the forces at both ends of a step over its way, half each, as central differences
/// turn them into motion: what they and the potential do not account for is the error of contact in time.
struct PairBook {
  Index other{};        ///< The body that does not keep the books
  double initial{};     ///< Potential when the run began [force*length]
  double energy{};      ///< Potential at the last evaluated forces [force*length]
  double dissipated{};  ///< By friction and damping [force*length], integrated
  double work{};        ///< On the body that keeps the books [force*length], integrated
  double work_other{};  ///< On the other one, or 0 where there is none [force*length], integrated

  /// What has come from nowhere (> 0) or gone there [force*length].
  [[nodiscard]] double open() const noexcept { return energy - initial + dissipated + work + work_other; }
  friend bool operator==(const PairBook&, const PairBook&) = default;
};

/// What acts on a tied node but for the tie itself, at the last evaluated forces.
struct TieState {
  Vec3d force;            ///< [force]
  Vec3d moment;           ///< About the node [force*length]; zero where it turns freely
  std::int64_t broken{};  ///< 1: the tie holds no more
};

/// What the acceleration of a node moves.
struct NodeInertia {
  double mass{};     ///< [mass]
  double inertia{};  ///< [mass*length^2]
};

/// The state at a step boundary: all that a restart or another machine needs.
struct State {
  std::int64_t step{};
  double time{};                                  // [time]
  AlignedVector<NodeMotion> motion;               // [nodes]
  AlignedVector<NodeAcceleration> acceleration;   // [nodes]
  AlignedVector<double> history;                  // [blocks][element_rows][block_lanes]
  AlignedVector<double> damping;                  // Likewise: what stiffness damping adds to resultants and drilling
                                                  // rotations, and the energy it has taken; empty without it
  AlignedVector<double> layers;                   // [layered blocks][physics::layer_rows][block_lanes]
  std::vector<RigidMotion> rigid;                 // [rigid bodies]; the motion of their nodes follows from it
  std::vector<TieState> ties;                     // [ties]
  AlignedVector<NodeInertia> moving;              // [nodes]; empty where no ties can break
  std::vector<double> tie_work;                   // [bodies]: of ties on them [force*length], integrated; empty where
                                                  // there are none
  std::vector<std::vector<ContactSide>> sides;    // [bodies]: sorted by (node, element); the body's nodes, and
                                                  // barriers' nodes with its elements
  std::vector<std::vector<EdgeSide>> edge_sides;  // [bodies]: sorted by (first, second); the first edge is the body's,
                                                  // or the second where the first is a barrier's
  /// Friction and damping of walls at the last step [force], shape [nodes][rubbing walls of the model]
  std::vector<Vec3d> wall_drag;
  std::vector<BodyLedger> ledger;                 // [bodies]
  std::vector<std::vector<PairBook>> pair_books;  // [bodies]: sorted by the other body; none that are all zero
};

/// State at time zero: reference positions, initial velocities as far as fixed nodes and planes of symmetry allow, no
/// stress; accelerations are left zero.
[[nodiscard]] State initial_state(const Model& model);

/// Copies one body's part of a state of the same model.
void copy_body(const Model& model, const State& from, Index body, State& to);

/// Appends the canonical little-endian bytes of one body's state: the one form used for hashes, checkpoints and the
/// wire. Padding lanes and struct padding are not part of it.
void append_body_bytes(const Model& model, const State& state, Index body, std::vector<std::byte>& bytes);

/// Takes one body's state from its canonical bytes; false, with the state untouched, when they do not fit the body.
[[nodiscard]] bool read_body_bytes(const Model& model, std::span<const std::byte> bytes, Index body, State& state);

/// Hash of one body's canonical bytes.
[[nodiscard]] std::uint64_t body_hash(const Model& model, const State& state, Index body);

/// Hash over step, time and all body hashes in ascending body order.
[[nodiscard]] std::uint64_t state_hash(const Model& model, const State& state);

/// What the acceleration of a node moves: its mass [mass] and inertia [mass*length^2] unless ties give it more or take
/// them away.
[[nodiscard]] inline double moving_mass(const Model& model, const State& state, Index node) noexcept {
  return state.moving.empty() ? model.moving_mass(node) : state.moving[at(node)].mass;
}
[[nodiscard]] inline double moving_inertia(const Model& model, const State& state, Index node) noexcept {
  return state.moving.empty() ? model.moving_inertia(node) : state.moving[at(node)].inertia;
}

/// The value of one row of a layered element.
[[nodiscard]] inline double layer_value(const Model& model, const State& state, Index element, Index row) {
  const ElementBlock& block = model.blocks[at(model.element_block[at(element)])];
  return state.layers[(at(block.layer_row) + at(row)) * at(block_lanes) + at(element - block.first)];
}

/// Whether the element has failed and takes part no more; `layers` is that of the state. Contact and loads are
/// evaluated before the elements in a step: for them, when the present state is looked at again without a step,
/// elements that failed at its end are still there, `steps` ago being 1. Otherwise it is 0.
[[nodiscard]] inline bool is_deleted(const Model& model, const double* layers, Index element, int steps = 0) {
  const ElementBlock& block = model.blocks[at(model.element_block[at(element)])];
  return block.layer_row != no_index &&
         layers[(at(block.layer_row) + physics::layer_deleted) * at(block_lanes) + at(element - block.first)] > steps;
}

/// What stiffness damping has taken from an element so far [force*length]; only where there is any.
[[nodiscard]] inline double damping_work(const Model& model, const State& state, Index element) {
  const Index block = model.element_block[at(element)];
  const Index lane = element - model.blocks[at(block)].first;
  return state.damping[(at(block) * element_rows + row_energy) * at(block_lanes) + at(lane)];
}

/// The value of one element row.
[[nodiscard]] inline double element_value(const Model& model, const State& state, Index element, ElementRow row) {
  const Index block = model.element_block[at(element)];
  const Index lane = element - model.blocks[at(block)].first;
  return state.history[(at(block) * element_rows + at(row)) * at(block_lanes) + at(lane)];
}

}  // namespace fexp::model
