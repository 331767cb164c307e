// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace fexp::bench {

/// Operations on numbers. Changes of sign and choices of the smaller number are no flops and are not counted.
struct OperationCount {
  std::int64_t additions{};  ///< And subtractions
  std::int64_t multiplications{};
  std::int64_t divisions{};
  std::int64_t square_roots{};

  /// A division or a square root counts as one, too.
  [[nodiscard]] std::int64_t flops() const noexcept { return additions + multiplications + divisions + square_roots; }
};

/// A number that counts what is done with it, for the templates that take any number type. One thread counts at a time.
class Counted {
 public:
  Counted() = default;
  // Implicit on purpose, as that of packs is.
  Counted(double value) noexcept : value_(value) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] double value() const noexcept { return value_; }

  /// What was done since the program began.
  [[nodiscard]] static OperationCount& count() noexcept {
    static OperationCount count;
    return count;
  }

  friend Counted operator+(const Counted& a, const Counted& b) noexcept {
    ++count().additions;
    return a.value_ + b.value_;
  }
  friend Counted operator-(const Counted& a, const Counted& b) noexcept {
    ++count().additions;
    return a.value_ - b.value_;
  }
  friend Counted operator*(const Counted& a, const Counted& b) noexcept {
    ++count().multiplications;
    return a.value_ * b.value_;
  }
  friend Counted operator/(const Counted& a, const Counted& b) noexcept {
    ++count().divisions;
    return a.value_ / b.value_;
  }
  friend Counted operator-(const Counted& a) noexcept { return -a.value_; }
  friend Counted square_root(const Counted& a) noexcept {
    ++count().square_roots;
    return std::sqrt(a.value_);
  }
  friend Counted minimum(const Counted& a, const Counted& b) noexcept { return a.value_ < b.value_ ? a : b; }

 private:
  double value_{};
};

/// What `work` does with counted numbers.
template <class Work>
[[nodiscard]] OperationCount count_operations(const Work& work) {
  Counted::count() = {};
  work();
  return Counted::count();
}

}  // namespace fexp::bench
