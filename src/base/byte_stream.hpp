// SPDX-License-Identifier: Apache-2.0
#pragma once

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

using Bytes = std::vector<std::byte>;

/// Puts values side by side as they stand in memory: for messages and snapshots that the same version reads again.
class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void value(const T& item) { append(&item, sizeof(T)); }
  /// Number of items, then the items.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void list(std::span<const T> items) {
    value(static_cast<std::uint64_t>(items.size()));
    append(items.data(), items.size_bytes());
  }
  template <class T>
  void list(const std::vector<T>& items) {
    list(std::span<const T>(items));
  }
  void text(std::string_view text) { list(std::span<const char>(text.data(), text.size())); }
  [[nodiscard]] Bytes& bytes() noexcept { return bytes_; }
  [[nodiscard]] Bytes take() noexcept { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t count) {
    const std::size_t before = bytes_.size();
    bytes_.resize(before + count);
    if (count > 0) {
      std::memcpy(bytes_.data() + before, from, count);
    }
  }

  Bytes bytes_;
};

/// Takes values in the order in which ByteWriter put them. Bytes that end too early give zeros and empty lists, and
/// sound() says so.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] T value() {
    T item{};
    if (const auto from = take(1, sizeof(T)); !from.empty()) {
      std::memcpy(static_cast<void*>(&item), from.data(), sizeof(T));
    }
    return item;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  [[nodiscard]] std::vector<T> list() {
    const auto count = value<std::uint64_t>();
    const auto from = take(count, sizeof(T));
    std::vector<T> items(from.size() / sizeof(T));
    if (!items.empty()) {
      std::memcpy(static_cast<void*>(items.data()), from.data(), from.size());
    }
    return items;
  }
  [[nodiscard]] std::string text() {
    const std::vector<char> letters = list<char>();
    return {letters.begin(), letters.end()};
  }
  /// The next `count` bytes as they are.
  [[nodiscard]] std::span<const std::byte> raw(std::size_t count) { return take(count, 1); }

  [[nodiscard]] bool sound() const noexcept { return sound_; }
  [[nodiscard]] bool at_end() const noexcept { return bytes_.empty(); }

 private:
  std::span<const std::byte> take(std::uint64_t count, std::size_t size) {
    if (!sound_ || count > bytes_.size() / size) {
      sound_ = false;
      return {};
    }
    const auto taken = bytes_.first(static_cast<std::size_t>(count) * size);
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

  std::span<const std::byte> bytes_;
  bool sound_{true};
};

}  // namespace fexp
