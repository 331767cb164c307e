// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace fexp::app {

/// log.txt of a run: one line for each event, with date and time. Failures throw OutputError.
class Log {
 public:
  enum class Begin { anew, go_on };
  explicit Log(std::filesystem::path path, Begin begin = Begin::anew);
  /// Reaches the file at once. Several threads may call it: the C library locks the file for the line.
  void line(std::string_view text);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { static_cast<void>(std::fclose(file)); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace fexp::app
