// SPDX-License-Identifier: Apache-2.0
#include "io/section_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_stream.hpp"
#include "base/hash.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "support/sections.hpp"
#include "support/temporary_directory.hpp"

namespace fexp::io {
namespace {

using test::bytes_of;
using test::some_sections;

/// What is said of damaged bytes; empty when they are taken.
std::string message_of(std::span<const std::byte> bytes) {
  try {
    static_cast<void>(unpack_sections(bytes, "a.fexp"));
  } catch (const OutputError& error) {
    EXPECT_EQ(error.path(), "a.fexp");
    EXPECT_FALSE(error.cure().empty());
    return error.message();
  }
  return "";
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const OutputError& error) {
    return error.message();
  }
  return "";
}

TEST(byte_stream, values_and_texts_come_back_in_order_and_no_more_than_there_are) {
  ByteWriter writer;
  writer.value(std::int64_t{-7});
  writer.text(std::string_view("a\0b", 3));
  writer.value(0.1);
  const Bytes bytes = writer.take();
  ASSERT_EQ(bytes.size(), 8U + 8U + 3U + 8U);
  EXPECT_EQ(bytes[0], std::byte{0xf9}) << "the lowest byte comes first";
  ByteReader reader(bytes);
  EXPECT_EQ(reader.value<std::int64_t>(), -7);
  EXPECT_EQ(reader.text(), std::string("a\0b", 3));
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.value<double>(), 0.1);
  EXPECT_TRUE(reader.at_end() && reader.sound());
  EXPECT_EQ(reader.value<std::int64_t>(), 0);
  EXPECT_FALSE(reader.sound());
  ByteReader cut{std::span(bytes).first(16)};
  EXPECT_EQ(cut.value<std::int64_t>(), -7);
  EXPECT_EQ(cut.text(), "") << "a length beyond the end";
  EXPECT_FALSE(cut.sound());
}

TEST(section_file, sections_come_back_in_their_order_with_any_bytes) {
  for (const std::vector<Section>& sections : {some_sections(), std::vector<Section>{}}) {
    EXPECT_EQ(unpack_sections(pack_sections(sections), "a.fexp"), sections);
  }
}

TEST(section_file, begins_with_magic_version_count_and_header_length) {
  const std::vector<std::byte> bytes = pack_sections(std::vector<Section>{{"ab", bytes_of("xyz")}});
  ByteWriter expected;
  expected.bytes() = bytes_of("FEXPSECT");
  expected.value(std::uint32_t{1});
  expected.value(std::uint32_t{1});
  expected.value(std::uint64_t{24 + 8 + 2 + 8 + 8 + 8});
  expected.text("ab");
  expected.value(std::uint64_t{3});
  expected.value(hash_bytes(bytes_of("xyz")));
  expected.value(hash_bytes(expected.bytes()));
  for (const std::byte byte : bytes_of("xyz")) {
    expected.value(byte);
  }
  EXPECT_EQ(bytes, expected.take());
}

TEST(section_file, what_is_wrong_is_told_by_name) {
  const std::vector<std::byte> sound = pack_sections(some_sections());
  EXPECT_EQ(message_of(bytes_of("[run]\nduration = 1\n")),
            "not a file of this kind, it does not begin with \"FEXPSECT\"");
  std::vector<std::byte> bytes = sound;
  bytes[8] = std::byte{7};
  EXPECT_EQ(message_of(bytes), "of format version 7, and this program knows versions up to 1");
  bytes = sound;
  bytes.resize(sound.size() - 10);
  EXPECT_EQ(message_of(bytes),
            "truncated at byte " + std::to_string(sound.size() - 10) + " of " + std::to_string(sound.size()));
  bytes.resize(20);
  EXPECT_EQ(message_of(bytes), "truncated at byte 20 of at least 32");
  EXPECT_EQ(message_of(std::vector<std::byte>{}), "truncated at byte 0 of at least 32");
  bytes = sound;
  bytes.back() ^= std::byte{1};
  EXPECT_EQ(message_of(bytes), "section \"last\" has been altered (checksum)");
  bytes = sound;
  bytes[33] ^= std::byte{1};
  EXPECT_EQ(message_of(bytes), "its header has been altered (checksum)");
  bytes = sound;
  bytes.push_back({});
  EXPECT_EQ(message_of(bytes), "1 bytes follow after its end");
}

TEST(section_file, no_single_bit_can_be_changed_unnoticed) {
  const std::vector<std::byte> sound = pack_sections(some_sections());
  std::vector<std::byte> bytes = sound;
  for (std::size_t i = 0; i < 8 * sound.size(); ++i) {
    const auto bit = static_cast<std::byte>(1U << i % 8);
    bytes[i / 8] ^= bit;
    ASSERT_NE(message_of(bytes), "") << "bit " << i;
    bytes[i / 8] ^= bit;
  }
}

TEST(section_file, no_file_cut_short_is_taken) {
  const std::vector<std::byte> sound = pack_sections(some_sections());
  for (std::size_t length = 0; length < sound.size(); ++length) {
    ASSERT_NE(message_of(std::span(sound).first(length)).find("truncated at byte "), std::string::npos) << length;
  }
}

TEST(section_file, a_header_that_announces_more_than_memory_holds_is_refused) {
  ByteWriter writer;
  writer.bytes() = bytes_of("FEXPSECT");
  writer.value(section_format);
  writer.value(std::uint32_t{2});
  writer.value(std::uint64_t{24 + 2 * 24 + 8});
  for (int i = 0; i < 2; ++i) {
    writer.text("");
    writer.value(~std::uint64_t{0} - 5);
    writer.value(std::uint64_t{0});
  }
  writer.value(hash_bytes(writer.bytes()));
  EXPECT_EQ(message_of(writer.bytes()), "its header has been altered (checksum)");
}

TEST(section_file, a_file_on_disk_holds_the_packed_bytes_and_replaces_the_one_before) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory.write("a.fexp", "old");
  write_sections(path, some_sections());
  const std::string text = read_whole(path);
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(text)), pack_sections(some_sections())));
  EXPECT_EQ(read_sections(path), some_sections());
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".new"));
}

TEST(section_file, a_section_that_is_not_there_is_an_error_with_its_name) {
  const std::vector<Section> sections = some_sections();
  EXPECT_EQ(&section_named(sections, "last", "a.fexp"), &sections.back());
  EXPECT_EQ(message_of([&] { static_cast<void>(section_named(sections, "none", "a.fexp")); }),
            "has no section \"none\"");
}

TEST(durable_file, that_cannot_be_written_leaves_the_one_before_and_nothing_half_done) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory.write("a", "old");
  // A directory in the place of the unfinished file stands for a place that cannot be written to.
  std::filesystem::create_directory(directory / "a.new");
  EXPECT_NE(message_of([&] { write_durably(path, bytes_of("new")); }).find("cannot write"), std::string::npos);
  EXPECT_EQ(read_whole(path), "old");
  EXPECT_THROW(write_durably(directory / "none" / "a", bytes_of("new")), OutputError);
  EXPECT_THROW(sync_directory(directory / "none"), OutputError);
}

}  // namespace
}  // namespace fexp::io
