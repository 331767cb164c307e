// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace fexp::io {

/// Replaces a file as a whole: whoever reads it finds the old text or the new one, never a part. Throws OutputError.
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// Likewise, from pieces that stand side by side in the file; when it returns they are on the disk and survive a crash
/// of the machine.
void write_durably(const std::filesystem::path& path, std::span<const std::span<const std::byte>> pieces);
void write_durably(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Puts a directory's list of files on the disk. Throws OutputError.
void sync_directory(const std::filesystem::path& directory);

/// All bytes of a file. Throws OutputError.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path);

}  // namespace fexp::io
