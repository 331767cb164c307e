// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "io/history.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

/// ties.csv: what the ties of each table of the deck transmit together.
namespace fexp::app {

/// Bodies whose states rows are made from, ascending.
[[nodiscard]] std::vector<Index> bodies_of_ties(const model::Model& model);

[[nodiscard]] std::vector<io::Column> tie_columns(const model::Model& model, const io::UnitNames& units);

/// A row of all tables.
void write_ties(const model::Model& model, const model::State& state, io::CsvWriter& file);

}  // namespace fexp::app
