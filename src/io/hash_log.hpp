// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "io/history.hpp"

namespace fexp::io {

/// Hash of one body's state after a step.
struct HashRow {
  std::int64_t step{};
  Index body{};
  std::uint64_t hash{};

  friend bool operator==(const HashRow&, const HashRow&) = default;
};

/// CSV with the columns step, body and hash (16 hexadecimal digits), ordered by step, then body.
class HashLogWriter {
 public:
  explicit HashLogWriter(std::filesystem::path path);
  /// Goes on after the first `bytes` bytes of a file, as CsvWriter does.
  [[nodiscard]] static HashLogWriter resume(std::filesystem::path path, std::uint64_t bytes);
  void append(const HashRow& row);
  void flush() { csv_.flush(); }
  void sync() { csv_.sync(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return csv_.bytes(); }
  void close() { csv_.close(); }

 private:
  explicit HashLogWriter(CsvWriter csv) : csv_(std::move(csv)) {}

  CsvWriter csv_;
};

/// Throws OutputError, naming the line, when the file is no hash log.
[[nodiscard]] std::vector<HashRow> read_hash_log(const std::filesystem::path& path);

}  // namespace fexp::io
