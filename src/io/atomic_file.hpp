// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fexp::io {

/// Replaces a file as a whole: whoever reads it finds the old text or the new one, never a part. Throws OutputError.
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// All bytes of a file. Throws OutputError.
[[nodiscard]] std::string read_whole(const std::filesystem::path& path);

}  // namespace fexp::io
