// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/output_mark.hpp"
#include "base/byte_stream.hpp"
#include "io/section_file.hpp"

namespace fexp::app {

/// A moment of a run as it is saved: the state of some or all bodies, and how far the outputs had come.
struct SavedRun {
  std::int64_t step{};
  double time{};  ///< [time]
  /// The parts that the state of this moment was saved in, of which this is one; the same list in all of them.
  std::vector<std::string> parts;
  std::string part;
  std::int64_t hash_every{};
  std::int64_t history{};  ///< Number of the take-up before it; see TakeUps
  OutputMark mark;
  Bytes piece;  ///< Of cluster::Simulation

  [[nodiscard]] std::vector<io::Section> sections() const;
  /// Throws OutputError, which names `file`.
  [[nodiscard]] static SavedRun from(std::span<const io::Section> sections, const std::filesystem::path& file);
};

}  // namespace fexp::app
