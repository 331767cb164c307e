// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/record.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

/// The threads of the coordinator and of the machines, a line for each set of machines that the run had one after the
/// other: the paper's table 2. Worlds that never stepped have none.
[[nodiscard]] std::string thread_table(const coordinator::ClusterRecord& record);

/// The same of every world, as RUN/threads.csv. Throws OutputError.
void write_thread_table(const io::RunDirectory& directory, const coordinator::ClusterRecord& record);

}  // namespace fexp::app
