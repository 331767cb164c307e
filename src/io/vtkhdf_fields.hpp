// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "model/capture.hpp"

/// The one list of what results hold: the writer, the XDMF file, the reader and the documents follow it.
namespace fexp::io {

enum class FieldPlace { node, element };
enum class Varies { always, where_plastic, never };
enum class FieldType { single_precision, double_precision, integer };

struct ResultField {
  std::string_view name;
  FieldPlace place;
  int components;
  FieldType type;
  Varies varies;
  std::string_view unit;  ///< Dimension
  std::string_view meaning;
  const void* (*data)(const model::Frame&);

  /// The same in every frame of a model with plastic materials or without: stored once.
  [[nodiscard]] constexpr bool constant(bool plastic) const noexcept {
    return varies == Varies::never || (varies == Varies::where_plastic && !plastic);
  }
};

/// Node and element fields in the order in which they are written; positions are not among them (VTKHDF: Points).
[[nodiscard]] std::span<const ResultField> result_fields() noexcept;

/// Path of a field's dataset in the file.
[[nodiscard]] std::string path_of(const ResultField& field);

/// Bytes of one component.
[[nodiscard]] constexpr std::size_t bytes_of(FieldType type) noexcept {
  return type == FieldType::double_precision ? 8 : 4;
}

/// Bytes of one node's or element's value.
[[nodiscard]] constexpr std::size_t row_bytes(const ResultField& field) noexcept {
  return static_cast<std::size_t>(field.components) * bytes_of(field.type);
}

}  // namespace fexp::io
