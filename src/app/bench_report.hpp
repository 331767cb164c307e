// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/cases.hpp"
#include "bench/hardware.hpp"
#include "io/history.hpp"

namespace fexp::app {

/// What the cases are held against.
struct BenchMachine {
  std::string processor;
  int hardware_threads{};
  std::string instruction_set;      ///< Of the element kernel: "baseline", "avx2" or "avx512"
  double cache_bytes{};             ///< All largest caches together; 0 when the system does not tell
  double array_bytes{};             ///< Each of the triad's three
  std::vector<bench::Roofs> roofs;  ///< By numbers of threads

  /// For so many threads, which must have been measured.
  [[nodiscard]] const bench::Roofs& roofs_of(int threads) const;
  /// For the most threads.
  [[nodiscard]] const bench::Roofs& most() const;
};

/// All that `fexp bench` tells.
struct BenchReport {
  BenchMachine machine;
  std::vector<bench::StepRow> steps;
  std::vector<bench::SearchRow> searches;

  [[nodiscard]] std::string text() const;
  [[nodiscard]] nlohmann::ordered_json json() const;
};

/// "1 thread", "2 threads"
[[nodiscard]] std::string threads_text(int threads);

/// A table of all rows, which has each of them as soon as it is there. Throws OutputError.
class BenchTable {
 public:
  explicit BenchTable(const std::filesystem::path& path);
  void add(const BenchMachine& machine, const bench::StepRow& row);
  void add(const BenchMachine& machine, const bench::SearchRow& row);
  void close() { csv_.close(); }

 private:
  void add(const nlohmann::ordered_json& row);

  io::CsvWriter csv_;
};

}  // namespace fexp::app
