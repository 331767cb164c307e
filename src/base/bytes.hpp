// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace fexp {

static_assert(std::endian::native == std::endian::little, "numbers are written as they stand in memory");

/// Puts little-endian numbers and texts side by side, without padding.
class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void number(T value) { bytes(std::as_bytes(std::span(&value, 1))); }
  /// Its length (uint64), then its characters.
  void text(std::string_view value) {
    number(static_cast<std::uint64_t>(value.size()));
    bytes(std::as_bytes(std::span(value)));
  }
  void bytes(std::span<const std::byte> value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }

  [[nodiscard]] const std::vector<std::byte>& written() const noexcept { return bytes_; }
  [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes what ByteWriter wrote, front to back. Every call is false, and its result untouched, where the bytes end too
/// early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) noexcept : rest_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  [[nodiscard]] bool number(T& value) noexcept {
    std::span<const std::byte> taken;
    if (!bytes(sizeof(T), taken)) {
      return false;
    }
    std::memcpy(&value, taken.data(), sizeof(T));
    return true;
  }
  [[nodiscard]] bool text(std::string& value) {
    std::uint64_t length = 0;
    std::span<const std::byte> taken;
    if (!number(length) || !bytes(length, taken)) {
      return false;
    }
    value.assign(reinterpret_cast<const char*>(taken.data()), taken.size());
    return true;
  }
  [[nodiscard]] bool bytes(std::uint64_t count, std::span<const std::byte>& taken) noexcept {
    if (count > rest_.size()) {
      return false;
    }
    taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(static_cast<std::size_t>(count));
    return true;
  }

  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace fexp
