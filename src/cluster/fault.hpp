// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/index.hpp"

namespace fexp::cluster {

enum class FaultKind { none, not_finite, step_collapsed, energy_drift, not_settled };

/// A physical failure of the run: what happened where, in one sentence, and the usual cure.
struct Fault {
  FaultKind kind{FaultKind::none};
  std::string message;
  std::string cure;
  Index body{no_index};
  Index element{no_index};
  Index node{no_index};
};

}  // namespace fexp::cluster
