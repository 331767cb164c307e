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
};

/// `before`: the state at the start of the epoch.
[[nodiscard]] BodyNotice notice_of(const model::Model& model, const model::State& before, const model::State& state,
                                   Index body);

}  // namespace fexp::cluster
