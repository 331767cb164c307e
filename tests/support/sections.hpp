// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/section_file.hpp"

namespace fexp::test {

inline std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Sections of lines, of arbitrary bytes and of none.
inline std::vector<io::Section> some_sections() {
  std::vector<io::Section> sections{{"text", bytes_of("one 1\ntwo 2\nthree 3\n")}, {"", {}}, {"all bytes", {}}};
  for (int i = 0; i < 256; ++i) {
    sections.back().bytes.push_back(static_cast<std::byte>(i));
  }
  sections.push_back({"last", bytes_of("the end")});
  return sections;
}

}  // namespace fexp::test
