// SPDX-License-Identifier: Apache-2.0
#include "app/tie_history.hpp"

#include <set>

#include "model/tie_forces.hpp"

namespace fexp::app {

std::vector<Index> bodies_of_ties(const model::Model& model) {
  std::set<Index> bodies;
  for (const model::Tie& tie : model.ties.ties) {
    bodies.insert(model.node_body[at(tie.node)]);
    bodies.insert(model.node_body[at(tie.carrier[0])]);
  }
  return {bodies.begin(), bodies.end()};
}

std::vector<io::Column> tie_columns(const model::Model& model, const io::UnitNames& units) {
  std::vector<io::Column> columns{{"step", ""}, {"time", units.of("time")}};
  for (const model::TieResult& table : model.ties.results) {
    io::add_vector_columns(columns, table.name, units.of("force"));
    columns.push_back({table.name + "_normal", units.of("force")});
    columns.push_back({table.name + "_shear", units.of("force")});
    io::add_vector_columns(columns, table.name + "_moment", units.of("force*length"));
    columns.push_back({table.name + "_broken", ""});
  }
  return columns;
}

void write_ties(const model::Model& model, const model::State& state, io::CsvWriter& file) {
  std::vector<io::Cell> cells{io::Cell(state.step), io::Cell(state.time)};
  for (std::size_t table = 0; table < model.ties.results.size(); ++table) {
    const model::TieResultant sum = model::tie_resultant(model, state, static_cast<Index>(table));
    io::add_vector_cells(cells, sum.force);
    cells.insert(cells.end(), {io::Cell(sum.normal), io::Cell(sum.shear)});
    io::add_vector_cells(cells, sum.moment);
    cells.emplace_back(model::broken_ties(model, state, static_cast<Index>(table)));
  }
  file.row(cells);
}

}  // namespace fexp::app
