// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/section_file.hpp"

namespace fexp::io {

/// A checkpoint that was found sound.
struct FoundCheckpoint {
  std::int64_t step{};
  std::filesystem::path path;
  std::vector<Section> sections;
  /// A sentence on each later one that is not sound and was passed over, latest first.
  std::vector<std::string> passed_over;
};

/// The checkpoints of a run: section files "step-000000001234.fexp" in a directory of their own, the newest two.
class CheckpointFiles {
 public:
  /// The directory is made with the first checkpoint.
  explicit CheckpointFiles(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// Writes a checkpoint; when it is on the disk, removes all but it and the latest of an earlier step. A checkpoint of
  /// a later step, left by a run that was taken up before it, goes too. Throws OutputError.
  void write(std::int64_t step, std::span<const Section> sections) const;

  /// The newest sound one. Throws OutputError, with what is wrong with each, when there is none.
  [[nodiscard]] FoundCheckpoint newest() const;

  /// Removes all checkpoints, and what a killed write has left.
  void clear() const;

  /// Of a step, whether it is there or not.
  [[nodiscard]] std::filesystem::path path(std::int64_t step) const;
  /// Steps of the files that are there, ascending.
  [[nodiscard]] std::vector<std::int64_t> steps() const;

 private:
  void remove_unfinished() const;

  std::filesystem::path directory_;
};

}  // namespace fexp::io
