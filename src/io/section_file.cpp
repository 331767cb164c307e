// SPDX-License-Identifier: Apache-2.0
#include "io/section_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/byte_stream.hpp"
#include "base/hash.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::io {

namespace {

constexpr std::string_view magic = "FEXPSECT";
/// Magic, version, number of sections, length of the header.
constexpr std::size_t fixed_bytes = magic.size() + 4 + 4 + 8;
constexpr std::size_t header_hash_bytes = 8;
constexpr const char* damaged_cure = "the file is damaged; take a copy of it, or an earlier one";

struct Entry {
  std::string name;
  std::uint64_t length{};
  std::uint64_t hash{};
};

void append(std::span<const std::byte> more, Bytes& bytes) { bytes.insert(bytes.end(), more.begin(), more.end()); }

Bytes header_of(std::span<const Section> sections) {
  ByteWriter table;
  for (const Section& section : sections) {
    table.text(section.name);
    table.value(static_cast<std::uint64_t>(section.bytes.size()));
    table.value(hash_bytes(section.bytes));
  }
  ByteWriter header;
  append(std::as_bytes(std::span(magic)), header.bytes());
  header.value(section_format);
  header.value(static_cast<std::uint32_t>(sections.size()));
  header.value(static_cast<std::uint64_t>(fixed_bytes + table.bytes().size() + header_hash_bytes));
  append(table.bytes(), header.bytes());
  header.value(hash_bytes(header.bytes()));
  return header.take();
}

/// Checks a file's bytes front to back, and throws at the first thing that is wrong.
class Unpacker {
 public:
  Unpacker(std::span<const std::byte> bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

  std::vector<Section> sections() {
    const std::uint32_t count = read_beginning();
    const std::vector<Entry> entries = read_table(count);
    check_size(entries);
    std::vector<Section> result;
    result.reserve(entries.size());
    std::size_t begin = header_bytes_;
    for (const Entry& entry : entries) {
      const auto length = static_cast<std::size_t>(entry.length);
      const std::span<const std::byte> content = bytes_.subspan(begin, length);
      if (hash_bytes(content) != entry.hash) {
        fail(fmt::format("section \"{}\" has been altered (checksum)", entry.name), damaged_cure);
      }
      result.push_back({entry.name, {content.begin(), content.end()}});
      begin += length;
    }
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& message, const char* cure) const {
    throw OutputError(file_, message, cure);
  }
  [[noreturn]] void fail_truncated(const std::string& whole) const {
    fail(fmt::format("truncated at byte {} of {}", bytes_.size(), whole), damaged_cure);
  }
  [[noreturn]] void fail_altered() const { fail("its header has been altered (checksum)", damaged_cure); }

  /// The number of sections; sets the header's length.
  std::uint32_t read_beginning() {
    const std::size_t known = std::min(bytes_.size(), magic.size());
    if (!std::ranges::equal(bytes_.first(known), std::as_bytes(std::span(magic)).first(known))) {
      fail("not a file of this kind, it does not begin with \"FEXPSECT\"", "name a file that fexp wrote");
    }
    ByteReader reader(bytes_.subspan(known));
    const auto version = reader.value<std::uint32_t>();
    if (version > section_format) {
      fail(fmt::format("of format version {}, and this program knows versions up to {}", version, section_format),
           "use the version of fexp that wrote the file, or a later one");
    }
    const auto count = reader.value<std::uint32_t>();
    const auto length = reader.value<std::uint64_t>();
    if (!reader.sound()) {
      fail_truncated(fmt::format("at least {}", fixed_bytes + header_hash_bytes));
    }
    if (version == 0 || length < fixed_bytes + header_hash_bytes) {
      fail_altered();
    }
    if (length > bytes_.size()) {
      fail_truncated(fmt::format("a header of {}", length));
    }
    header_bytes_ = static_cast<std::size_t>(length);
    return count;
  }

  std::vector<Entry> read_table(std::uint32_t count) const {
    const std::size_t hashed = header_bytes_ - header_hash_bytes;
    if (ByteReader(bytes_.subspan(hashed)).value<std::uint64_t>() != hash_bytes(bytes_.first(hashed))) {
      fail_altered();
    }
    ByteReader reader(bytes_.first(hashed).subspan(fixed_bytes));
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < count; ++i) {
      Entry entry;
      entry.name = reader.text();
      entry.length = reader.value<std::uint64_t>();
      entry.hash = reader.value<std::uint64_t>();
      if (!reader.sound()) {
        fail_altered();
      }
      entries.push_back(std::move(entry));
    }
    if (!reader.at_end()) {
      fail_altered();
    }
    return entries;
  }

  void check_size(const std::vector<Entry>& entries) const {
    std::uint64_t whole = header_bytes_;
    for (const Entry& entry : entries) {
      if (entry.length > std::numeric_limits<std::uint64_t>::max() - whole) {
        fail_altered();
      }
      whole += entry.length;
    }
    if (whole > bytes_.size()) {
      fail_truncated(std::to_string(whole));
    }
    if (whole < bytes_.size()) {
      fail(fmt::format("{} bytes follow after its end", bytes_.size() - whole), damaged_cure);
    }
  }

  std::span<const std::byte> bytes_;
  const std::filesystem::path& file_;
  std::size_t header_bytes_{};
};

}  // namespace

std::vector<std::byte> pack_sections(std::span<const Section> sections) {
  std::vector<std::byte> bytes = header_of(sections);
  for (const Section& section : sections) {
    append(section.bytes, bytes);
  }
  return bytes;
}

std::vector<Section> unpack_sections(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  return Unpacker(bytes, file).sections();
}

void write_sections(const std::filesystem::path& path, std::span<const Section> sections) {
  const std::vector<std::byte> header = header_of(sections);
  std::vector<std::span<const std::byte>> pieces{header};
  for (const Section& section : sections) {
    pieces.emplace_back(section.bytes);
  }
  write_durably(path, pieces);
}

std::vector<Section> read_sections(const std::filesystem::path& path) {
  const std::string bytes = read_whole(path);
  return unpack_sections(std::as_bytes(std::span(bytes)), path);
}

const Section& section_named(std::span<const Section> sections, std::string_view name,
                             const std::filesystem::path& file) {
  const auto found = std::ranges::find(sections, name, &Section::name);
  if (found == sections.end()) {
    throw OutputError(file, fmt::format("has no section \"{}\"", name),
                      "name a file of the right kind, that this version of fexp wrote");
  }
  return *found;
}

}  // namespace fexp::io
