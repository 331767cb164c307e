// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/capture.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::model {

/// Some elements of a model, with their nodes.
struct Cutout {
  std::vector<Index> elements;                 // In the order in which they are cut out
  std::vector<Index> nodes;                    // Those of the elements, in the order in which these name them
  std::vector<std::array<Index, 3>> triangle;  // [elements], into `nodes`
  std::vector<Index> node_body;                // [nodes]
  std::vector<std::int64_t> node_label;        // [nodes]
  std::vector<std::int64_t> element_label;     // [elements]
};

/// At most `most` elements whose centres are closest to that of `element`, which comes first; of equal ones the lower
/// come first.
[[nodiscard]] Cutout neighbourhood(const Model& model, const State& state, Index element, Index most);

/// What a frame of the whole model says of the elements and nodes that are cut out.
[[nodiscard]] Frame cut_out(const Frame& frame, const Cutout& cutout);

}  // namespace fexp::model
