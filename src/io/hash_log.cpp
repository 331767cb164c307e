// SPDX-License-Identifier: Apache-2.0
#include "io/hash_log.hpp"

#include <charconv>
#include <string>
#include <utility>

#include "base/hash.hpp"
#include "io/output_error.hpp"

namespace fexp::io {

namespace {

template <class T>
bool parse(const std::string& text, T& value, int base = 10) {
  const char* end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value, base);
  return code == std::errc{} && stop == end;
}

std::vector<Column> columns() { return {{"step", ""}, {"body", ""}, {"hash", ""}}; }

}  // namespace

HashLogWriter::HashLogWriter(std::filesystem::path path) : csv_(std::move(path), columns()) {}

HashLogWriter HashLogWriter::resume(std::filesystem::path path, std::uint64_t bytes) {
  return HashLogWriter(CsvWriter::resume(std::move(path), columns(), bytes));
}

void HashLogWriter::append(const HashRow& row) {
  const std::string hash = hash_text(row.hash);
  csv_.row({row.step, static_cast<std::int64_t>(row.body), std::string_view(hash)});
}

std::vector<HashRow> read_hash_log(const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  bool good = table.header == std::vector<std::string>{"step", "body", "hash"};
  std::vector<HashRow> rows;
  for (std::size_t i = 0; good && i < table.rows.size(); ++i) {
    const std::vector<std::string>& cells = table.rows[i];
    HashRow row;
    good = cells.size() == 3 && parse(cells[0], row.step) && parse(cells[1], row.body) && cells[2].size() == 16 &&
           parse(cells[2], row.hash, 16);
    rows.push_back(row);
  }
  if (!good) {
    throw OutputError(path, "not a hash log (line " + std::to_string(rows.size() + 1) + ")",
                      "give a run directory written with --hash-every");
  }
  return rows;
}

}  // namespace fexp::io
