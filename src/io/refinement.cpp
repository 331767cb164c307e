// SPDX-License-Identifier: Apache-2.0
#include "io/refinement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include "io/field_text.hpp"

namespace fexp::io {

namespace {

/// Every whole number of a mesh generator is a number of cells.
template <class Generator>
void refine(const Refinement& refinement, const model::BodyDescription& body, Generator& mesh, ErrorList& errors) {
  for_each_field<Generator>([&](const auto& field) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(field)>::ValueType, int>) {
      int& cells = mesh.*field.member;
      const double wanted = refinement.factor * cells;
      if (wanted != std::floor(wanted) || !field.range.contains(wanted)) {
        errors.add(refinement.place,
                   fmt::format("refinement.factor is {:g}: body \"{}\" would have {} = {:g}", refinement.factor,
                               body.name, field.name, wanted),
                   fmt::format("a whole number ({})", field.range.text),
                   "correct the factor, or the cells of the mesh");
      } else {
        cells = static_cast<int>(wanted);
      }
    }
  });
}

}  // namespace

void refine_meshes(const Refinement& refinement, std::vector<model::BodyDescription>& bodies, ErrorList& errors) {
  if (refinement.factor == 1.0) {
    return;
  }
  for (model::BodyDescription& body : bodies) {
    if (auto* generator = std::get_if<model::MeshGenerator>(&body.mesh)) {
      std::visit([&](auto& mesh) { refine(refinement, body, mesh, errors); }, *generator);
    } else {
      errors.add(refinement.place,
                 fmt::format("refinement.factor is {:g}: the mesh of body \"{}\" comes from a file", refinement.factor,
                             body.name),
                 "generated meshes only", "remove [refinement], and make a file for each mesh");
    }
  }
}

}  // namespace fexp::io
