// SPDX-License-Identifier: Apache-2.0
#include "io/section_file.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "io/output_error.hpp"
#include "support/damage.hpp"
#include "support/sections.hpp"

namespace fexp::io {
namespace {

constexpr const char* nasty[] = {"", "0", "FEXPSECT", "\n", "99999999999999999999"};

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(damaged_sections, are_refused_or_are_the_sections_that_were_written) {
  const std::vector<Section> sections = test::some_sections();
  const std::string sound = text_of(pack_sections(sections));
  std::mt19937 random(20180625);
  int refused = 0;
  for (int i = 0; i < 50000; ++i) {
    const std::string text = test::damaged(sound, random, nasty);
    try {
      ASSERT_EQ(unpack_sections(std::as_bytes(std::span(text)), "fuzz"), sections) << "file " << i;
      ASSERT_EQ(text, sound) << "damage that nobody noticed";
    } catch (const OutputError& error) {
      ASSERT_FALSE(error.message().empty() || error.cure().empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, 40000) << "hardly any damage was done";
}

TEST(damaged_sections, random_bytes_are_refused) {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 200, '\0');
    for (char& c : bytes) {
      c = static_cast<char>(random() & 0xffU);
    }
    if (i % 2 == 0) {  // As far as the checksum of the header.
      bytes.insert(0, std::string("FEXPSECT\1\0\0\0", 12));
    }
    EXPECT_THROW(static_cast<void>(unpack_sections(std::as_bytes(std::span(bytes)), "fuzz")), OutputError);
  }
}

}  // namespace
}  // namespace fexp::io
