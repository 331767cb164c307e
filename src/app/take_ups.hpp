// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/byte_stream.hpp"

namespace fexp::app {

/// The steps at which a run was begun or taken up, in order: its files were cut back there each time. A saved moment
/// speaks of files as long as they were then, so it is of use only while nothing has been cut off since; a machine that
/// was away may come back with one that is not.
class TakeUps {
 public:
  /// Those of the run's directory; none when there is no such file. Throws OutputError.
  [[nodiscard]] static TakeUps read(const std::filesystem::path& file);
  void write(const std::filesystem::path& file) const;

  void add(std::int64_t step) { steps_.push_back(step); }
  /// How often the run was begun or taken up.
  [[nodiscard]] std::int64_t count() const noexcept { return static_cast<std::int64_t>(steps_.size()); }
  /// Whether the files still have all that they had at a moment: `history` is count() at the time it was saved.
  [[nodiscard]] bool keep(std::int64_t history, std::int64_t step) const noexcept;

  [[nodiscard]] Bytes pack() const;
  [[nodiscard]] static TakeUps unpack(const Bytes& bytes);

 private:
  std::vector<std::int64_t> steps_;
};

}  // namespace fexp::app
