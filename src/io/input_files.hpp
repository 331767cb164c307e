// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fexp::io {

/// The files that a model is built from, the deck and its meshes, by the names they were asked for. They come from the
/// disk, or from bytes that another machine or an earlier run has packed; either way they have the same names.
class InputFiles {
 public:
  /// Reads from the disk, and keeps in memory nothing but what a file that can be read only once had (a pipe).
  InputFiles() = default;
  /// Serves what pack() has packed and nothing else. `origin` is the name of the bytes in errors. Throws OutputError.
  [[nodiscard]] static InputFiles unpack(std::span<const std::byte> bytes, const std::filesystem::path& origin);

  /// Likewise, from a file of such bytes.
  [[nodiscard]] static InputFiles packed_in(const std::filesystem::path& file);

  enum class Kind { file, missing, directory, other };
  [[nodiscard]] Kind kind(const std::filesystem::path& path) const;
  [[nodiscard]] bool from_memory() const noexcept { return from_memory_; }

  /// All bytes of a file. Throws OutputError when it cannot be read, or is not what it was when it was read before.
  [[nodiscard]] std::string read(const std::filesystem::path& path);

  /// Name of the file that was read first, which is the deck; empty before.
  [[nodiscard]] std::filesystem::path deck() const;
  /// Every file that was read or unpacked, read once more from the disk where it came from there. Throws OutputError
  /// when one has changed meanwhile.
  [[nodiscard]] std::vector<std::byte> pack() const;

 private:
  struct File {
    std::string name;
    std::uint64_t size{};
    std::uint64_t hash{};
    std::optional<std::string> bytes;
  };
  [[nodiscard]] const File* find(const std::string& name) const;
  [[nodiscard]] static std::string read_again(const File& file);

  std::vector<File> files_;
  bool from_memory_{};
};

}  // namespace fexp::io
