// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"
#include "quality/finding.hpp"

namespace fexp::quality {

/// The first copy of every described body, in the order of the description. Copies of an array are alike.
[[nodiscard]] inline std::vector<Index> first_copies(const model::Model& model) {
  std::vector<Index> bodies;
  for (Index b = 0; b < model.meshed_body_count(); ++b) {
    if (bodies.empty() || model.bodies[at(b)].description != model.bodies[at(bodies.back())].description) {
      bodies.push_back(b);
    }
  }
  return bodies;
}

/// Whether a body is the first copy of its description.
[[nodiscard]] inline bool is_first_copy(const model::Model& model, Index body) {
  return body == 0 || model.bodies[at(body)].description != model.bodies[at(body - 1)].description;
}

/// Counts an item, and names it while there is room.
inline void add_item(Finding& finding, std::int64_t label) {
  ++finding.count;
  if (finding.ids.size() < most_ids) {
    finding.ids.push_back(label);
  }
}

}  // namespace fexp::quality
