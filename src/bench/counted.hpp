// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "base/pack.hpp"

namespace fexp::bench {

/// Operations on numbers. Changes of sign and choices between numbers are no flops and are not counted.
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
  friend Counted maximum(const Counted& a, const Counted& b) noexcept { return a.value_ > b.value_ ? a : b; }
  friend Counted select_less(const Counted& a, const Counted& b, const Counted& yes, const Counted& no) noexcept {
    return a.value_ < b.value_ ? yes : no;
  }
  friend bool any_less(const Counted& a, const Counted& b) noexcept { return a.value_ < b.value_; }
  friend Counted split_exponent(const Counted& x, Counted& exponent) noexcept {
    ++count().additions;
    return fexp::split_exponent(x.value_, exponent.value_);
  }
  friend Counted times_power_of_two(const Counted& x, const Counted& exponent) noexcept {
    ++count().additions;
    ++count().multiplications;
    return fexp::times_power_of_two(x.value_, exponent.value_);
  }

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
