// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "io/vtkhdf_fields.hpp"

namespace fexp::io {

/// Reads back what ResultsWriter wrote, also while it writes and after it was killed. Failures throw OutputError.
class ResultsReader {
 public:
  explicit ResultsReader(const std::filesystem::path& path);
  ResultsReader(ResultsReader&&) noexcept;
  ~ResultsReader();

  [[nodiscard]] std::int64_t frames() const noexcept { return static_cast<std::int64_t>(times_.size()); }
  [[nodiscard]] Index nodes() const noexcept { return nodes_; }
  [[nodiscard]] Index elements() const noexcept { return elements_; }
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }        ///< [frames]
  [[nodiscard]] const std::vector<std::int64_t>& steps() const noexcept { return steps_; }  ///< [frames]
  [[nodiscard]] const std::vector<std::string>& body_names() const noexcept { return body_names_; }
  /// Whether the field is the same in all frames.
  [[nodiscard]] bool is_constant(const ResultField& field) const noexcept { return field.constant(variety_); }
  [[nodiscard]] const std::string& title() const noexcept { return title_; }
  [[nodiscard]] const std::string& program() const noexcept { return program_; }

  /// Body of each node, shape [nodes].
  [[nodiscard]] std::vector<Index> node_bodies() const;
  [[nodiscard]] std::vector<std::int64_t> node_labels() const;
  [[nodiscard]] std::vector<std::int64_t> element_labels() const;
  [[nodiscard]] std::vector<std::int64_t> connectivity() const;

  /// Positions of a frame: x y z of each node, shape [3 x nodes] [length].
  [[nodiscard]] std::vector<double> points(std::int64_t frame) const;
  /// A field of a frame as it is stored: bytes of floats, doubles or 32-bit integers, components side by side.
  [[nodiscard]] std::vector<std::byte> raw(const ResultField& field, std::int64_t frame) const;
  /// A field of a frame as numbers.
  [[nodiscard]] std::vector<double> numbers(const ResultField& field, std::int64_t frame) const;

 private:
  struct File;
  [[nodiscard]] std::size_t rows_of(const ResultField& field) const {
    return at(field.place == FieldPlace::node ? nodes_ : elements_);
  }

  std::unique_ptr<File> file_;
  Index nodes_{};
  Index elements_{};
  Variety variety_{};
  std::vector<double> times_;
  std::vector<std::int64_t> steps_;
  std::vector<std::string> body_names_;
  std::string title_;
  std::string program_;
};

}  // namespace fexp::io
