// SPDX-License-Identifier: Apache-2.0
#include "io/input_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/byte_stream.hpp"
#include "base/hash.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "io/section_file.hpp"

namespace fexp::io {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t packed_format = 1;
/// The section in front of those of the files.
constexpr const char* head_name = "inputs";
constexpr std::string_view file_prefix = "file:";

std::uint64_t hash_of(std::string_view bytes) { return hash_bytes(std::as_bytes(std::span(bytes))); }

Section section_of(const std::string& name, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {std::string(file_prefix) + name, {bytes.begin(), bytes.end()}};
}

void check_head(std::span<const Section> sections, const fs::path& origin) {
  const auto format = ByteReader(section_named(sections, head_name, origin).bytes).value<std::uint32_t>();
  if (format == 0 || format > packed_format) {
    throw OutputError(origin,
                      fmt::format("packed input files of format {}, and this program knows {}", format, packed_format),
                      "use the version of fexp that wrote them, or a later one");
  }
}

}  // namespace

InputFiles InputFiles::packed_in(const fs::path& file) {
  const std::string bytes = read_whole(file);
  return unpack(std::as_bytes(std::span(bytes)), file);
}

InputFiles InputFiles::unpack(std::span<const std::byte> bytes, const fs::path& origin) {
  const std::vector<Section> sections = unpack_sections(bytes, origin);
  check_head(sections, origin);
  InputFiles files;
  files.from_memory_ = true;
  for (const Section& section : sections) {
    if (section.name.starts_with(file_prefix)) {
      std::string text(reinterpret_cast<const char*>(section.bytes.data()), section.bytes.size());
      const std::uint64_t hash = hash_of(text);
      files.files_.push_back({section.name.substr(file_prefix.size()), text.size(), hash, std::move(text)});
    }
  }
  return files;
}

const InputFiles::File* InputFiles::find(const std::string& name) const {
  const auto found = std::ranges::find(files_, name, &File::name);
  return found == files_.end() ? nullptr : &*found;
}

InputFiles::Kind InputFiles::kind(const fs::path& path) const {
  if (from_memory_) {
    return find(path.string()) == nullptr ? Kind::missing : Kind::file;
  }
  std::error_code error;
  switch (fs::status(path, error).type()) {
    case fs::file_type::none:
    case fs::file_type::not_found:
      return Kind::missing;
    case fs::file_type::regular:
      return Kind::file;
    case fs::file_type::directory:
      return Kind::directory;
    default:
      return Kind::other;
  }
}

std::string InputFiles::read_again(const File& file) {
  if (file.bytes) {
    return *file.bytes;
  }
  std::string bytes = read_whole(file.name);
  if (bytes.size() != file.size || hash_of(bytes) != file.hash) {
    throw OutputError(file.name, "the file has changed since it was read",
                      "start again, and leave the deck and its meshes alone until the first step");
  }
  return bytes;
}

std::string InputFiles::read(const fs::path& path) {
  const std::string name = path.string();
  if (const File* known = find(name)) {
    return read_again(*known);
  }
  if (from_memory_) {
    throw OutputError(path, "cannot read: not among the packed input files", "run the deck again from the start");
  }
  std::string bytes = read_whole(path);
  File file{name, bytes.size(), hash_of(bytes), {}};
  if (kind(path) != Kind::file) {
    file.bytes = bytes;
  }
  files_.push_back(std::move(file));
  return bytes;
}

fs::path InputFiles::deck() const { return files_.empty() ? fs::path() : fs::path(files_.front().name); }

std::vector<std::byte> InputFiles::pack() const {
  ByteWriter head;
  head.value(packed_format);
  std::vector<Section> sections{{head_name, head.take()}};
  for (const File& file : files_) {
    sections.push_back(section_of(file.name, read_again(file)));
  }
  return pack_sections(sections);
}

}  // namespace fexp::io
