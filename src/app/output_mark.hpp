// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "base/byte_stream.hpp"

namespace fexp::app {

/// How far the files of a run have come, for a checkpoint: whoever takes the run up again cuts them back to here.
struct OutputMark {
  std::int64_t frames{};        ///< In the results file
  std::int64_t frame_step{-1};  ///< Step of the last frame, -1 for none
  std::int64_t row_step{-1};    ///< Step of the last rows, -1 for none
  /// Length of each CSV file that the run writes, by its name without extension.
  std::map<std::string, std::uint64_t> csv_bytes;
  // What the histories have summed up since their last rows.
  std::int64_t searches{};
  std::int64_t rollbacks{};
  double deepest{};

  void note(const std::filesystem::path& csv, std::uint64_t bytes) { csv_bytes[csv.stem().string()] = bytes; }
  /// Length of a CSV file. Throws OutputError when the run did not write it.
  [[nodiscard]] std::uint64_t bytes_of(const std::filesystem::path& csv) const;

  friend bool operator==(const OutputMark&, const OutputMark&) = default;

  [[nodiscard]] Bytes pack() const;
  /// Throws OutputError, which names `origin`, when the bytes are no mark.
  [[nodiscard]] static OutputMark unpack(std::span<const std::byte> bytes, const std::filesystem::path& origin);
};

}  // namespace fexp::app
