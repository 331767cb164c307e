// SPDX-License-Identifier: Apache-2.0
#include "io/history.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

#include "io/atomic_file.hpp"
#include "io/hash_log.hpp"
#include "io/output_error.hpp"
#include "support/temporary_directory.hpp"

namespace fexp {
namespace {

using test::TemporaryDirectory;

TEST(history, header_has_names_and_units) {
  const TemporaryDirectory directory;
  std::vector<io::Column> columns{{"step", ""}, {"time", "ms"}};
  io::add_vector_columns(columns, "force", "kN");
  io::CsvWriter(directory / "a.csv", columns).close();
  EXPECT_EQ(io::read_whole(directory / "a.csv"), "step,time [ms],force_x [kN],force_y [kN],force_z [kN]\n");
}

TEST(history, units_are_the_users_where_given_and_dimensions_elsewhere) {
  const io::UnitNames units{.length = "mm", .time = "ms", .mass = "", .force = "kN", .temperature = "K"};
  EXPECT_EQ(units.of("force/length^2"), "kN/mm^2");
  EXPECT_EQ(units.of("force*length*time"), "kN*mm*ms");
  EXPECT_EQ(units.of("1/time"), "1/ms");
  EXPECT_EQ(units.of("mass*length/time^2"), "mass*mm/ms^2");
  EXPECT_EQ(units.of("temperature"), "K");
  EXPECT_EQ(units.of("-"), "-");
  EXPECT_EQ(io::UnitNames{}.of("length/time"), "length/time");
}

TEST(history, every_number_comes_back_to_the_bit) {
  const TemporaryDirectory directory;
  std::mt19937_64 random(7);
  std::vector<double> values{0.0, -0.0, 0.1, 1.0 / 3.0, 1e300, 5e-324, std::numeric_limits<double>::max(), -1e-17};
  for (int i = 0; i < 10000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) {
      values.push_back(value);
    }
  }
  io::CsvWriter writer(directory / "a.csv", {{"value", ""}});
  for (const double value : values) {
    writer.row({value});
  }
  writer.close();
  const io::CsvTable table = io::read_csv(directory / "a.csv");
  ASSERT_EQ(table.rows.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double back = std::strtod(table.rows[i][0].c_str(), nullptr);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(values[i])) << table.rows[i][0];
  }
}

TEST(history, short_numbers_stay_short) {
  const TemporaryDirectory directory;
  io::CsvWriter writer(directory / "a.csv", {{"a", ""}, {"b", ""}, {"c", ""}});
  writer.row({0.1, std::int64_t{-3}, std::string_view("x,\"y\"")});
  writer.close();
  EXPECT_EQ(io::read_whole(directory / "a.csv"), "a,b,c\n0.1,-3,\"x,\"\"y\"\"\"\n");
  EXPECT_EQ(io::read_csv(directory / "a.csv").rows[0][2], "x,\"y\"");
}

TEST(history, the_file_never_holds_half_a_line) {
  const TemporaryDirectory directory;
  io::CsvWriter writer(directory / "a.csv", {{"a", ""}, {"b", ""}});
  for (int i = 0; i < 20000; ++i) {
    writer.row({1.0 / (i + 3), static_cast<std::int64_t>(i)});
    if (i % 1000 == 0) {
      EXPECT_EQ(io::read_whole(directory / "a.csv").back(), '\n');
    }
  }
  EXPECT_GT(io::read_csv(directory / "a.csv").rows.size(), 10000U) << "rows wait without bound";
  writer.flush();
  EXPECT_EQ(io::read_csv(directory / "a.csv").rows.size(), 20000U);
}

TEST(history, goes_on_after_the_length_it_had_and_drops_what_follows) {
  const TemporaryDirectory directory;
  const std::vector<io::Column> columns{{"a", "s"}};
  io::CsvWriter first(directory / "a.csv", columns);
  EXPECT_EQ(first.bytes(), 6U);
  first.row({1.0});
  first.flush();
  const std::uint64_t bytes = first.bytes();
  first.row({2.0});
  first.row({3.0});
  first.sync();
  EXPECT_EQ(first.bytes(), std::filesystem::file_size(directory / "a.csv"));
  std::ofstream(directory / "a.csv", std::ios::app) << "3.1";
  for (int i = 0; i < 2; ++i) {
    io::CsvWriter writer = io::CsvWriter::resume(directory / "a.csv", columns, bytes);
    EXPECT_EQ(writer.bytes(), bytes);
    writer.row({4.5});
    writer.close();
    EXPECT_EQ(writer.bytes(), bytes + 4);
    EXPECT_EQ(io::read_whole(directory / "a.csv"), "a [s]\n1\n4.5\n");
  }
}

TEST(history, does_not_go_on_in_a_file_that_is_not_what_it_was) {
  const TemporaryDirectory directory;
  const auto error_of = [&](const char* text, std::uint64_t bytes) -> std::string {
    const std::filesystem::path path = directory.write("a.csv", text);
    try {
      (void)io::CsvWriter::resume(path, {{"a", "s"}}, bytes);
    } catch (const io::OutputError& error) {
      EXPECT_EQ(error.path(), path);
      EXPECT_NE(error.cure().find("put the file back"), std::string::npos);
      EXPECT_EQ(io::read_whole(path), text) << "the refused file was changed";
      return error.message();
    }
    return "";
  };
  EXPECT_EQ(error_of("a [s]\n1\n", 8), "");
  EXPECT_EQ(error_of("b [s]\n1\n", 8), "cannot go on: the file has other columns");
  EXPECT_EQ(error_of("a [", 8), "cannot go on: the file has other columns");
  EXPECT_EQ(error_of("a [s]\n1\n", 10),
            "cannot go on: the file has 8 bytes, and the run had written 10 before the checkpoint");
  for (const std::uint64_t bytes : {7U, 2U, 0U}) {
    EXPECT_NE(error_of("a [s]\n1\n", bytes).find("no row ends at byte"), std::string::npos);
  }
  EXPECT_THROW((void)io::CsvWriter::resume(directory / "none.csv", {{"a", "s"}}, 6), io::OutputError);
  EXPECT_FALSE(std::filesystem::exists(directory / "none.csv"));
}

TEST(history, a_full_disk_is_an_error_with_path) {
  try {
    const io::CsvWriter writer("/dev/full", {{"a", ""}});
    FAIL() << "wrote to a full disk";
  } catch (const io::OutputError& error) {
    EXPECT_EQ(error.path(), "/dev/full");
    EXPECT_NE(error.cure().find("free some space"), std::string::npos);
  }
}

TEST(history, rows_of_another_length_are_refused) {
  const TemporaryDirectory directory;
  io::CsvWriter writer(directory / "a.csv", {{"a", ""}, {"b", ""}});
  EXPECT_THROW(writer.row({1.0}), io::OutputError);
}

TEST(hash_log, comes_back_as_written) {
  const TemporaryDirectory directory;
  const std::vector<io::HashRow> rows{{0, 0, 0xffffffffffffffffU}, {0, 1, 0}, {10, 0, 0x123456789abcdefU}};
  io::HashLogWriter writer(directory / "h.csv");
  for (const io::HashRow& row : rows) {
    writer.append(row);
  }
  writer.close();
  EXPECT_EQ(io::read_hash_log(directory / "h.csv"), rows);
  EXPECT_NE(io::read_whole(directory / "h.csv").find("10,0,0123456789abcdef\n"), std::string::npos);
}

TEST(hash_log, a_line_that_makes_no_sense_is_named) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "h.csv") << "step,body,hash\n0,0,0123456789abcdef\n1,0,xyz\n";
  try {
    (void)io::read_hash_log(directory / "h.csv");
    FAIL() << "read nonsense";
  } catch (const io::OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 3"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fexp
