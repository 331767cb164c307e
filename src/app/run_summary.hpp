// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/load.hpp"
#include "app/time_loop.hpp"
#include "cluster/simulation.hpp"
#include "io/summary.hpp"

namespace fexp::app {

/// The run in numbers, without frames, files and wall time.
[[nodiscard]] io::Summary summarise(const Case& loaded, const cluster::Simulation& simulation, const RunEnd& end);

/// Several lines for a reader: energies with their balance, momenta, steps, time taken, files.
[[nodiscard]] std::string summary_text(const io::Summary& summary, const io::UnitNames& units,
                                       const solve::Diagnostics& start, const solve::Diagnostics& present);

}  // namespace fexp::app
