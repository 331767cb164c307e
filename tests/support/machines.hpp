// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cluster/placement.hpp"

namespace fexp::test {

/// Machines of these speeds, one rank each.
inline std::vector<cluster::Machine> machines_of(const std::vector<double>& speeds) {
  std::vector<cluster::Machine> machines;
  for (const double speed : speeds) {
    cluster::Machine machine;
    machine.rank = static_cast<int>(machines.size());
    machine.speed = speed;
    machines.push_back(machine);
  }
  return machines;
}

}  // namespace fexp::test
