// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "io/history.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::app {

/// elements.csv: what elements bear that have all their nodes in a node set.
class ElementHistory {
 public:
  /// `sets` are names of node sets that are there.
  ElementHistory(const model::Model& model, const std::vector<std::string>& sets);

  [[nodiscard]] bool empty() const noexcept { return sets_.empty(); }
  /// Bodies whose states rows are made from, ascending.
  [[nodiscard]] std::vector<Index> bodies() const;
  [[nodiscard]] static std::vector<io::Column> columns(const io::UnitNames& units);
  /// A row for each element.
  void write(const model::State& state, io::CsvWriter& file) const;

 private:
  struct Set {
    const model::NamedNodes* nodes;
    std::vector<Index> elements;  // Ascending
  };

  [[nodiscard]] Index body_of(Index element) const { return model_.blocks[at(model_.element_block[at(element)])].body; }

  const model::Model& model_;
  std::vector<Set> sets_;
};

}  // namespace fexp::app
