// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cluster/relaxation.hpp"
#include "cluster/swept_boxes.hpp"
#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/diagnostics.hpp"

namespace fexp::cluster {

/// What every rank knows of every body at an epoch's start, whoever owns it: enough to decide alike on step, islands,
/// placement and balances.
struct BodyNotice {
  BodyExtent extent;
  solve::CriticalStep critical;  ///< Of its elements
  solve::Diagnostics diagnostics;
  RelaxationSums relaxation;  ///< Of a static analysis
  double contact_work{};      ///< Of contact forces on it since the start [force*length]
  double tie_work{};          ///< Likewise of ties
  double wall_dissipation{};  ///< What friction and damping of walls have taken of it [force*length]
  /// Of the pairs that it keeps the books of the one that is off the most; `other` is no_index where it keeps none.
  model::PairBook worst_pair{.other = no_index};
  Index ties{};        ///< Of its nodes that hold
  double pairs_off{};  ///< Sum of moduli of what all of these are off [force*length]

  /// What the body has and has given away, less what was put in: constant in exact arithmetic and time, whatever other
  /// bodies do. Contact and ties count by their work; that of walls is a potential of the body.
  [[nodiscard]] double own_balance() const noexcept {
    const solve::Energies& e = diagnostics.energies;
    return e.kinetic + e.internal + e.barrier + e.damping + wall_dissipation - e.external - contact_work - tie_work;
  }
};

/// `before`: the state at the start of the epoch.
[[nodiscard]] BodyNotice notice_of(const model::Model& model, const model::State& before, const model::State& state,
                                   Index body);

}  // namespace fexp::cluster
