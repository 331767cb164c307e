// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

namespace fexp::io {

/// A file could not be written or read back: disk full, no permission, not what it should be.
class OutputError : public std::runtime_error {
 public:
  OutputError(std::filesystem::path path, std::string message, std::string cure)
      : std::runtime_error(path.string() + ": error: " + message + "; cure: " + cure),
        path_(std::move(path)),
        message_(std::move(message)),
        cure_(std::move(cure)) {}

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& message() const noexcept { return message_; }
  [[nodiscard]] const std::string& cure() const noexcept { return cure_; }

 private:
  std::filesystem::path path_;
  std::string message_;
  std::string cure_;
};

}  // namespace fexp::io
