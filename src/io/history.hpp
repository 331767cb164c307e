// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "base/field.hpp"
#include "base/vec3.hpp"

namespace fexp::io {

/// The user's names of units, as the deck gives them ("mm", "ms", "kg", "kN"). They are echoed, never computed with;
/// an empty name stands for the dimension itself.
struct UnitNames {
  std::string length;
  std::string time;
  std::string mass;
  std::string force;
  std::string temperature;

  static constexpr auto fields = std::tuple{
      Field{"length", "-", "Name of the unit of length, such as \"mm\".", &UnitNames::length},
      Field{"time", "-", "Name of the unit of time.", &UnitNames::time},
      Field{"mass", "-", "Name of the unit of mass.", &UnitNames::mass},
      Field{"force", "-", "Name of the unit of force.", &UnitNames::force},
      Field{"temperature", "-", "Name of the unit of temperature.", &UnitNames::temperature},
  };

  /// "force/length^2" -> "kN/mm^2"; the dimension's own words where no name is given; "-" stays.
  [[nodiscard]] std::string of(std::string_view dimension) const;
};

/// One column of a history: its header is "name [unit]", or the name alone when the unit is empty.
struct Column {
  std::string name;
  std::string unit;
};

using Cell = std::variant<std::int64_t, double, std::string_view>;

/// Comma-separated values with a header row. Numbers have the fewest digits that give the same number back. Lines reach
/// the file whole, so a killed run leaves no half line. Failures throw OutputError.
class CsvWriter {
 public:
  /// Creates the file, replacing one of that name, and writes the header.
  CsvWriter(std::filesystem::path path, std::vector<Column> columns);
  /// Goes on in a file with the same header after its first `bytes` bytes, which end a line; what follows is dropped.
  [[nodiscard]] static CsvWriter resume(std::filesystem::path path, std::vector<Column> columns, std::uint64_t bytes);
  CsvWriter(CsvWriter&& other) noexcept;
  CsvWriter& operator=(CsvWriter&& other) noexcept;
  ~CsvWriter();

  /// Appends a row; as many cells as columns.
  void row(std::span<const Cell> cells);
  void row(std::initializer_list<Cell> cells) { row(std::span(cells.begin(), cells.size())); }
  /// Hands all rows so far to the operating system; rows also go out by themselves when 64 KiB are waiting.
  void flush();
  /// Puts all rows so far on the disk.
  void sync();
  void close();

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Length of the file; after flush() that of all rows so far.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  CsvWriter(std::filesystem::path path, std::vector<Column> columns, int flags);

  std::filesystem::path path_;
  std::vector<Column> columns_;
  std::string waiting_;
  std::uint64_t bytes_{};
  int file_{-1};
};

/// Appends columns "<name>_x", "_y", "_z".
void add_vector_columns(std::vector<Column>& columns, const std::string& name, const std::string& unit);
/// Appends the three components as cells.
void add_vector_cells(std::vector<Cell>& cells, const Vec3d& value);

/// A table read back: the header cells and the rows' texts.
struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< Whole lines only
};
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& path);

}  // namespace fexp::io
