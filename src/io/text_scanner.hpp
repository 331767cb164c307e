// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/errors.hpp"

namespace fexp::io {

/// Reads words and numbers from a text in memory and knows the line and column of each, for error messages. Spaces,
/// tabs and carriage returns part words. The text must outlive the scanner. Failures throw InputErrors.
class TextScanner {
 public:
  /// Whether words are looked for beyond the end of the line. Where lines end statements, a backslash at the end of a
  /// line continues it.
  enum class Lines { flow, end_statements };

  TextScanner(std::string_view text, std::string file, Lines lines)
      : text_(text), file_(std::move(file)), lines_(lines) {}

  /// Next word, or empty at the end of the text (or of the line, where lines end statements).
  [[nodiscard]] std::string_view word();
  /// Next word without taking it.
  [[nodiscard]] std::string_view peek();
  /// What remains of the line, without surrounding spaces.
  [[nodiscard]] std::string_view rest_of_line();
  /// Goes to the beginning of the next line; false when there is none.
  bool next_line();
  /// Takes a text between double quotes.
  [[nodiscard]] std::string_view quoted(std::string_view what);

  /// A finite number of at most 1e100 in size, which leaves room for squares and products.
  [[nodiscard]] double real(std::string_view what);
  [[nodiscard]] std::int64_t integer(std::string_view what, std::int64_t low, std::int64_t high);
  /// A number of items that follow, each of at least `bytes_each` characters: a count that cannot be true is refused
  /// before memory is asked for.
  [[nodiscard]] std::size_t count(std::string_view what, std::size_t bytes_each);
  /// Takes the next word, which must be `expected`.
  void expect(std::string_view expected);

  [[nodiscard]] std::size_t remaining() const noexcept { return text_.size() - position_; }
  [[nodiscard]] int line() const noexcept { return line_; }
  /// Where the last word begins.
  [[nodiscard]] Place place() const;
  [[noreturn]] void fail(std::string message, std::string accepted, std::string cure) const;
  /// Fails at the word last taken, which is not `what`; or says that the text has ended.
  [[noreturn]] void fail_unexpected(std::string_view what, std::string_view found, std::string accepted) const;

 private:
  void skip_space() noexcept;
  /// Whether a number that ends here ends as a word does.
  [[nodiscard]] bool word_ends(const char* end) const noexcept;

  std::string_view text_;
  std::string file_;
  Lines lines_;
  std::size_t position_{0};
  std::size_t word_begin_{0};
  std::size_t line_begin_{0};
  int line_{1};
};

/// The word as it may be shown in a message: shortened, without control characters.
[[nodiscard]] std::string shown(std::string_view word);

/// A capital ASCII letter's small one; other characters as they are.
[[nodiscard]] char lower_case(char c) noexcept;

/// Whether two words are the same but for the case of ASCII letters.
[[nodiscard]] bool same_but_case(std::string_view a, std::string_view b) noexcept;

}  // namespace fexp::io
