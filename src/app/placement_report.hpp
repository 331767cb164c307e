// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cluster/simulation.hpp"
#include "io/history.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"

namespace fexp::app {

/// Machines and changes of placement as the summary has them.
[[nodiscard]] io::Summary::Placement placement_of(const cluster::Simulation& simulation);

/// How quiet the network was, how balanced the work, and what another machine would save.
[[nodiscard]] io::Summary::Network network_of(const cluster::Simulation& simulation);

/// The table of placements as in table 1 of the paper, and the threads of each machine as in its table 2. Long tables
/// are cut in the middle; the CSV file has all rows.
[[nodiscard]] std::string placement_text(const io::Summary::Placement& placement, const io::UnitNames& units);

/// Writes placement.csv: a row for each machine and change of placement. Nothing for a run on one machine. Throws
/// OutputError.
void write_placement(const io::RunDirectory& directory, const io::Summary& summary, const io::UnitNames& units);

}  // namespace fexp::app
