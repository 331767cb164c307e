// SPDX-License-Identifier: Apache-2.0
#include "app/element_history.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "model/element_stresses.hpp"

namespace fexp::app {

namespace {

std::vector<Index> elements_within(const model::Model& model, const std::vector<Index>& nodes) {
  std::vector<char> chosen(at(model.node_count()));
  for (const Index n : nodes) {
    chosen[at(n)] = 1;
  }
  std::vector<Index> elements;
  for (Index e = 0; e < model.element_count(); ++e) {
    if (std::ranges::all_of(model.triangle[at(e)], [&](Index n) { return chosen[at(n)] != 0; })) {
      elements.push_back(e);
    }
  }
  return elements;
}

void add_columns(std::vector<io::Column>& columns, const std::string& name, std::initializer_list<const char*> parts,
                 const std::string& unit) {
  for (const char* part : parts) {
    columns.push_back({name + part, unit});
  }
}

template <std::size_t N>
void add_cells(std::vector<io::Cell>& cells, const std::array<double, N>& values) {
  cells.insert(cells.end(), values.begin(), values.end());
}

}  // namespace

ElementHistory::ElementHistory(const model::Model& model, const std::vector<std::string>& sets) : model_(model) {
  for (const model::NamedNodes& set : model.node_sets) {
    if (std::ranges::find(sets, set.name) != sets.end()) {
      sets_.push_back({&set, elements_within(model, set.nodes)});
    }
  }
}

std::vector<Index> ElementHistory::bodies() const {
  std::set<Index> bodies;
  for (const Set& set : sets_) {
    for (const Index e : set.elements) {
      bodies.insert(body_of(e));
    }
  }
  return {bodies.begin(), bodies.end()};
}

std::vector<io::Column> ElementHistory::columns(const io::UnitNames& units) {
  std::vector<io::Column> columns{{"step", ""}, {"time", units.of("time")}, {"set", ""}, {"body", ""}, {"element", ""}};
  add_columns(columns, "membrane_force", {"_xx", "_yy", "_xy"}, units.of("force/length"));
  add_columns(columns, "bending_moment", {"_xx", "_yy", "_xy"}, units.of("force"));
  add_columns(columns, "shear_force", {"_xz", "_yz"}, units.of("force/length"));
  add_columns(columns, "stress_top", {"_xx", "_yy", "_xy"}, units.of("force/length^2"));
  add_columns(columns, "stress_bottom", {"_xx", "_yy", "_xy"}, units.of("force/length^2"));
  columns.push_back({"thickness", units.of("length")});
  columns.push_back({"plastic_strain", ""});
  columns.push_back({"deleted", ""});
  columns.push_back({"temperature", units.of("temperature")});
  return columns;
}

void ElementHistory::write(const model::State& state, io::CsvWriter& file) const {
  for (const Set& set : sets_) {
    for (const Index e : set.elements) {
      const model::ElementStresses s = model::element_stresses(model_, state, e);
      std::vector<io::Cell> cells{state.step, state.time, std::string_view(set.nodes->name),
                                  std::string_view(model_.bodies[at(body_of(e))].name), model_.element_label[at(e)]};
      add_cells(cells, s.membrane_force);
      add_cells(cells, s.bending_moment);
      add_cells(cells, s.shear_force);
      add_cells(cells, s.top);
      add_cells(cells, s.bottom);
      cells.insert(cells.end(), {io::Cell(s.thickness), io::Cell(s.plastic_strain),
                                 io::Cell(static_cast<std::int64_t>(s.deleted ? 1 : 0)), io::Cell(s.temperature)});
      file.row(cells);
    }
  }
}

}  // namespace fexp::app
