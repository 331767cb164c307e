// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "app/element_history.hpp"
#include "app/load.hpp"
#include "app/output_mark.hpp"
#include "cluster/simulation.hpp"
#include "io/history.hpp"
#include "io/run_directory.hpp"

namespace fexp::app {

/// The run's CSV files: energies, momenta and steps of the whole model, and where the deck asks for them forces of
/// rigid walls, what ties transmit, motions of nodes and of bodies, and what elements bear. Every row begins with step
/// and time.
class Histories {
 public:
  /// Creates the files, or goes on where `mark` says.
  Histories(const io::RunDirectory& directory, const Case& loaded, const OutputMark* mark = nullptr);

  /// Bodies whose states rows are made from, ascending.
  [[nodiscard]] static std::vector<Index> bodies_needed(const Case& loaded);

  /// Takes note of what an epoch did; the next row of steps.csv tells of all epochs since the row before.
  void add(const cluster::EpochReport& report);
  /// One row (or one for each node, element and body) of the present state in every file.
  void write(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  void flush();
  /// Puts all rows so far on the disk.
  void sync();
  /// Notes how far the files have come; after flush().
  void mark(OutputMark& mark);
  void close();

 private:
  void write_energies(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  void write_momenta(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  void write_steps(const cluster::Simulation& simulation, const cluster::EpochReport& report);
  void write_walls(const cluster::Simulation& simulation);
  void write_nodes(const cluster::Simulation& simulation);
  void write_bodies(const cluster::Simulation& simulation);
  [[nodiscard]] std::vector<io::CsvWriter*> files();

  const model::Model& model_;
  io::CsvWriter energies_;
  io::CsvWriter momenta_;
  io::CsvWriter steps_;
  std::optional<io::CsvWriter> walls_;
  std::optional<io::CsvWriter> ties_;
  std::optional<io::CsvWriter> nodes_;
  std::optional<io::CsvWriter> elements_;
  std::optional<io::CsvWriter> bodies_;
  std::vector<const model::NamedNodes*> sets_;  ///< Whose nodes are written
  ElementHistory element_history_;
  std::vector<Index> chosen_;  ///< Bodies that are written, ascending
  // Since the last row of steps.csv.
  std::int64_t searches_{};
  std::int64_t rollbacks_{};
  double deepest_{};
};

}  // namespace fexp::app
