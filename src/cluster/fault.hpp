// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "cluster/watchdog.hpp"

namespace fexp::cluster {

/// step_not_found: with every smaller step the model has turned out to need a still smaller one.
enum class FaultKind { none, not_finite, step_collapsed, step_not_found, energy_drift, not_settled };

/// A physical failure of the run: what happened where, in one sentence, and the usual cure.
struct Fault {
  FaultKind kind{FaultKind::none};
  std::string message;
  std::string cure;
  Index body{no_index};
  Index other{no_index};  ///< The second body of a pair, which may be the first one itself
  Index element{no_index};
  std::int64_t step{};  ///< In which a velocity is not finite
  Index node{no_index};
  double share{};                   ///< Of a drift, what the culprit has of it [-]
  std::vector<EpochRow> epochs;     ///< The last ones, the oldest first
  std::vector<BodyRow> rows;        ///< Of `body` at their ends
  std::vector<BodyRow> rows_other;  ///< Of `other`
};

}  // namespace fexp::cluster
