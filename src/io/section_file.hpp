// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Named sections of bytes in one file, with a version, and with checksums that reveal every change. docs/formats.md
/// has the layout.
namespace fexp::io {

struct Section {
  std::string name;
  std::vector<std::byte> bytes;

  friend bool operator==(const Section&, const Section&) = default;
};

/// Version of the layout; what the bytes of a section mean is for whoever writes them.
constexpr std::uint32_t section_format = 1;

[[nodiscard]] std::vector<std::byte> pack_sections(std::span<const Section> sections);

/// Takes the sections out of packed bytes, in their order. Throws OutputError, which names `file` and what is wrong: no
/// such file at all, of a newer version, truncated, altered.
[[nodiscard]] std::vector<Section> unpack_sections(std::span<const std::byte> bytes, const std::filesystem::path& file);

/// Writes pack_sections(sections) durably, without a second copy of the bytes in memory. Throws OutputError.
void write_sections(const std::filesystem::path& path, std::span<const Section> sections);

/// Throws OutputError as unpack_sections does, and when the file cannot be read.
[[nodiscard]] std::vector<Section> read_sections(const std::filesystem::path& path);

/// The first section of that name. Throws OutputError, which names `file`, when there is none.
[[nodiscard]] const Section& section_named(std::span<const Section> sections, std::string_view name,
                                           const std::filesystem::path& file);

}  // namespace fexp::io
