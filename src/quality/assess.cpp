// SPDX-License-Identifier: Apache-2.0
#include "quality/assess.hpp"

#include <algorithm>
#include <iterator>

namespace fexp::quality {

std::vector<Finding> assess(const model::Model& model, std::span<const model::Mesh> meshes) {
  std::vector<Finding> all;
  const auto add = [&all](std::vector<Finding> found) {
    std::move(found.begin(), found.end(), std::back_inserter(all));
  };
  add(turned_normals(model, meshes));
  add(loose_pieces(model));
  add(free_edges(model));
  add(near_nodes(model));
  add(overlapping_shells(model));
  add(far_tied_nodes(model));
  add(slivers(model));
  add(added_mass(model));
  std::stable_partition(all.begin(), all.end(), [](const Finding& f) { return f.severity == Severity::warning; });
  return all;
}

}  // namespace fexp::quality
