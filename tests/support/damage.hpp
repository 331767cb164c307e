// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <string>

namespace fexp::test {

/// Damages a text at random in one to four places: bytes and digits changed, pieces cut off, removed or repeated, lines
/// removed or moved, words replaced by nasty ones.
inline std::string damaged(std::string text, std::mt19937& random, std::span<const char* const> nasty) {
  const auto below = [&random](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random()) % n; };
  const std::size_t changes = 1 + below(4);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t begin = below(text.size()), length = 1 + below(std::min<std::size_t>(60, text.size() - begin));
    const std::size_t line_end = std::min(text.find('\n', begin), text.size());
    const std::size_t line = std::min(text.rfind('\n', begin) + 1, line_end);
    switch (below(9)) {
      case 0:
        text[begin] = static_cast<char>(random() & 0xffU);
        break;
      case 1:
        text[begin] = static_cast<char>('0' + below(10));
        break;
      case 2:
        text.resize(begin);
        break;
      case 3:
        text.erase(begin, length);
        break;
      case 4:
        text.insert(below(text.size()), text.substr(begin, length));
        break;
      case 5:
        text.erase(line, line_end - line);
        break;
      case 6: {
        const std::string moved = text.substr(line, line_end - line) + "\n";
        const std::size_t to = text.rfind('\n', below(text.size())) + 1;
        text.insert(std::min(to, text.size()), moved);
        break;
      }
      default: {
        const std::size_t word = text.find_first_of(" \n", begin);
        if (word != std::string::npos) {
          const std::size_t end = std::min(text.find_first_of(" ,\n", word + 1), text.size());
          text.replace(word + 1, end - word - 1, nasty[below(nasty.size())]);
        }
      }
    }
  }
  return text;
}

}  // namespace fexp::test
