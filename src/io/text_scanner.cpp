// SPDX-License-Identifier: Apache-2.0
#include "io/text_scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace fexp::io {

namespace {

constexpr double largest_real = 1.0e100;
/// Limits beyond this are of no interest to the user.
constexpr std::int64_t most_shown = std::int64_t{1} << 62;

bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool is_space(char c) noexcept { return is_blank(c) || c == '\n'; }

}  // namespace

char lower_case(char c) noexcept { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string shown(std::string_view word) {
  constexpr std::size_t most = 40;
  std::string text(word.substr(0, most));
  for (char& c : text) {
    if (c < ' ' || c > '~') {
      c = '?';
    }
  }
  return word.size() > most ? text + "..." : text;
}

bool same_but_case(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower_case(x) == lower_case(y); });
}

void TextScanner::skip_space() noexcept {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '\n') {
      if (lines_ == Lines::end_statements) {
        return;
      }
      ++line_;
      line_begin_ = position_ + 1;
    } else if (c == '\\' && lines_ == Lines::end_statements) {
      const std::size_t end = text_.find_first_not_of('\r', position_ + 1);
      if (end == std::string_view::npos || text_[end] != '\n') {
        return;
      }
      position_ = end;
      ++line_;
      line_begin_ = end + 1;
    } else if (!is_blank(c)) {
      return;
    }
    ++position_;
  }
}

std::string_view TextScanner::word() {
  skip_space();
  word_begin_ = position_;
  while (position_ < text_.size() && !is_space(text_[position_])) {
    ++position_;
  }
  return text_.substr(word_begin_, position_ - word_begin_);
}

std::string_view TextScanner::peek() {
  const std::string_view next = word();
  position_ = word_begin_;
  return next;
}

std::string_view TextScanner::rest_of_line() {
  while (position_ < text_.size() && is_blank(text_[position_])) {
    ++position_;
  }
  word_begin_ = position_;
  position_ = std::min(text_.find('\n', position_), text_.size());
  std::size_t end = position_;
  while (end > word_begin_ && is_blank(text_[end - 1])) {
    --end;
  }
  return text_.substr(word_begin_, end - word_begin_);
}

bool TextScanner::next_line() {
  const std::size_t end = text_.find('\n', position_);
  if (end == std::string_view::npos) {
    position_ = word_begin_ = text_.size();
    return false;
  }
  position_ = word_begin_ = line_begin_ = end + 1;
  ++line_;
  return position_ < text_.size();
}

std::string_view TextScanner::quoted(std::string_view what) {
  skip_space();
  word_begin_ = position_;
  const std::size_t line_end = std::min(text_.find('\n', position_), text_.size());
  if (position_ < text_.size() && text_[position_] == '"') {
    const std::size_t close = text_.find('"', position_ + 1);
    if (close < line_end) {
      position_ = close + 1;
      return text_.substr(word_begin_ + 1, close - word_begin_ - 1);
    }
  }
  const std::string_view found = word();
  fail_unexpected(what, found, "a text between double quotes");
}

bool TextScanner::word_ends(const char* end) const noexcept {
  return end == text_.data() + text_.size() || is_space(*end);
}

double TextScanner::real(std::string_view what) {
  skip_space();
  word_begin_ = position_;
  const char* begin = text_.data() + position_;
  const char* const end = text_.data() + text_.size();
  if (begin != end && *begin == '+') {
    ++begin;
  }
  double value = 0.0;
  const auto [stop, code] = std::from_chars(begin, end, value);
  // Numbers too small for a double read as zero; numbers too large fail below.
  const bool underflow = code == std::errc::result_out_of_range && std::fabs(value) < 1.0;
  if ((code != std::errc{} && !underflow) || !word_ends(stop) || !(std::fabs(value) <= largest_real)) {
    const std::string_view found = word();
    fail_unexpected(what, found, "a finite number, at most 1e100 in size");
  }
  position_ = static_cast<std::size_t>(stop - text_.data());
  return value;
}

std::int64_t TextScanner::integer(std::string_view what, std::int64_t low, std::int64_t high) {
  skip_space();
  word_begin_ = position_;
  const char* begin = text_.data() + position_;
  const char* const end = text_.data() + text_.size();
  if (begin != end && *begin == '+') {
    ++begin;
  }
  std::int64_t value = 0;
  const auto [stop, code] = std::from_chars(begin, end, value);
  if (code != std::errc{} || !word_ends(stop) || value < low || value > high) {
    const std::string_view found = word();
    fail_unexpected(what, found,
                    high < most_shown   ? fmt::format("a whole number from {} to {}", low, high)
                    : low > -most_shown ? fmt::format("a whole number >= {}", low)
                                        : "a whole number");
  }
  position_ = static_cast<std::size_t>(stop - text_.data());
  return value;
}

std::size_t TextScanner::count(std::string_view what, std::size_t bytes_each) {
  const auto number = static_cast<std::size_t>(integer(what, 0, INT64_MAX));
  const std::size_t most = remaining() / bytes_each;
  if (number > most) {
    fail(fmt::format("{} is {}, but only {} characters follow", what, number, remaining()),
         fmt::format("at most {} here", most), "the file is cut off or damaged: export it again");
  }
  return number;
}

void TextScanner::expect(std::string_view expected) {
  const std::string_view found = word();
  if (!same_but_case(found, expected)) {
    fail_unexpected(fmt::format("\"{}\"", expected), found, fmt::format("\"{}\"", expected));
  }
}

Place TextScanner::place() const {
  return {file_, line_, static_cast<int>(std::min<std::size_t>(word_begin_ - line_begin_, INT32_MAX - 1)) + 1};
}

void TextScanner::fail(std::string message, std::string accepted, std::string cure) const {
  throw InputErrors({{place(), std::move(message), std::move(accepted), std::move(cure)}});
}

void TextScanner::fail_unexpected(std::string_view what, std::string_view found, std::string accepted) const {
  if (found.empty()) {
    const bool ended = word_begin_ >= text_.size();
    fail(fmt::format("the {} ends where {} should stand", ended ? "file" : "line", what), std::move(accepted),
         ended ? "the file is cut off or damaged: export it again" : "complete the line");
  }
  fail(fmt::format("{} should stand here, not \"{}\"", what, shown(found)), std::move(accepted),
       "correct the line, or export the file again");
}

}  // namespace fexp::io
