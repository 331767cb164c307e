// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "cluster/simulation.hpp"
#include "io/history.hpp"
#include "io/summary.hpp"
#include "model/model.hpp"

namespace fexp::app {

/// The last epochs of the bodies that a fault names, as a table of some lines; empty where it names none or no epoch
/// was completed.
[[nodiscard]] std::string history_text(const model::Model& model, const cluster::Fault& fault,
                                       const io::UnitNames& units);

/// Where the fault is, with the user's names and numbers.
[[nodiscard]] io::Summary::FaultPlace place_of(const model::Model& model, const cluster::Fault& fault);

/// Writes what is around the fault, at the start of the last epoch and now, in the layout of the results. False, with
/// nothing written, where the fault is at no place. On rank 0, when it has collected both states. Throws OutputError.
bool write_neighbourhood(const std::filesystem::path& path, const cluster::Simulation& simulation,
                         const cluster::Fault& fault);

}  // namespace fexp::app
