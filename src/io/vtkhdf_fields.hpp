// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "model/capture.hpp"

/// The one list of what results hold: the writer, the XDMF file, the reader and the documents follow it.
namespace fexp::io {

/// Of the file: which fields there are, and where.
inline constexpr int results_format = 2;

enum class FieldPlace { node, element };
enum class Varies { always, where_plastic, where_tied, never };
enum class FieldType { single_precision, double_precision, integer };

/// What there is in a model that has fields vary.
struct Variety {
  bool plastic{};
  bool tied{};

  [[nodiscard]] static Variety of(const model::Model& model) noexcept { return {model.plastic, !model.ties.empty()}; }
};

struct ResultField {
  std::string_view name;
  FieldPlace place;
  int components;
  FieldType type;
  Varies varies;
  std::string_view unit;  ///< Dimension
  std::string_view meaning;
  const void* (*data)(const model::Frame&);

  /// The same in every frame: stored once.
  [[nodiscard]] constexpr bool constant(const Variety& variety) const noexcept {
    return varies == Varies::never || (varies == Varies::where_plastic && !variety.plastic) ||
           (varies == Varies::where_tied && !variety.tied);
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
