// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cluster/placement.hpp"

namespace fexp::app {

/// What another machine would save, in words: "one island is 83 % of the work: more than 2 machines do not help".
[[nodiscard]] std::string balance_text(const cluster::BalanceReport& balance);

}  // namespace fexp::app
