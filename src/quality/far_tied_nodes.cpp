// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "quality/assess.hpp"

namespace fexp::quality {

std::vector<Finding> far_tied_nodes(const model::Model& model) {
  std::vector<Finding> findings;
  for (const model::TieResult& result : model.ties.results) {
    if (result.far.empty()) {
      continue;
    }
    Finding finding;
    finding.kind = "far_tied_nodes";
    finding.item = "node";
    finding.count = static_cast<std::int64_t>(result.far.size());
    for (std::size_t i = 0; i < result.far.size() && i < most_ids; ++i) {
      finding.ids.push_back(model.node_label[at(result.far[i])]);
    }
    finding.body = model.bodies[at(model.node_body[at(result.far.front())])].family;
    finding.numbers = {{"tied", static_cast<double>(result.tied)}, {"closest", result.distance}};
    finding.message = fmt::format(
        "tie \"{}\" holds {} nodes and leaves {} free that are too far from its surface, the closest of them {:.4g}",
        result.name, result.tied, finding.count, result.distance);
    finding.cure = "if they are meant to hold, too, give the tie a larger distance; else take them out of the set";
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
