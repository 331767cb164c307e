// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "quality/assess.hpp"
#include "quality/nearest.hpp"

namespace fexp::quality {

namespace {

/// Nodes nearer than this part of their elements' size are likely to be meant as one.
constexpr double near_part = 0.02;

bool share_element(const model::Model& model, Index a, Index b) {
  for (Index c = model.corner_start[at(a)]; c < model.corner_start[at(a) + 1]; ++c) {
    const auto& t = model.triangle[at(model.corner[at(c)] / 3)];
    if (t[0] == b || t[1] == b || t[2] == b) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Finding> near_nodes(const model::Model& model) {
  contact::KdTree tree;
  tree.build(model.reference_position);
  const auto box = [&](Index n) {
    Box around;
    around.include(model.reference_position[at(n)]);
    return around.grown(near_part * model.node_size[at(n)]);
  };
  const auto distance = [&](Index n, Index other) {
    const Index body = model.node_body[at(n)], other_body = model.node_body[at(other)];
    const double d = norm(model.reference_position[at(n)] - model.reference_position[at(other)]);
    const bool near = d <= near_part * std::min(model.node_size[at(n)], model.node_size[at(other)]);
    const bool fixed = model.bodies[at(body)].barrier && model.bodies[at(other_body)].barrier;
    const bool joined = model.ties.are_joined(n, other) || share_element(model, n, other);
    return near && !fixed && is_told(model, body, other_body) && !joined ? d : HUGE_VAL;
  };
  const std::vector<Partner> partners = nearest_partners(tree, model.node_count(), box, distance);

  std::vector<Finding> findings;
  for (const PairGroup& group : group_pairs(model, partners, [&](Index n) { return model.node_body[at(n)]; })) {
    Finding finding = finding_of(model, group, [&](Index n) { return model.node_label[at(n)]; });
    double largest = 0.0;
    for (const auto& [a, b] : group.pairs) {
      largest = std::max(largest, norm(model.reference_position[at(a)] - model.reference_position[at(b)]));
    }
    finding.item = "node";
    finding.numbers = {{"largest_distance", largest}};
    if (group.same_body) {
      finding.kind = "duplicate_nodes";
      finding.message =
          fmt::format("{} pairs of nodes lie on each other, at most {:.4g} apart", finding.count, largest);
      finding.cure = "elements on either side do not hold together there; merge the nodes in the mesh";
    } else {
      finding.kind = "unjoined_bodies";
      finding.message = fmt::format("{} of its nodes lie on nodes of body \"{}\", at most {:.4g} apart", finding.count,
                                    model.bodies[at(group.other_body)].family, largest);
      finding.cure = "bodies are not joined by that; if they are to hold together, make them parts of one mesh";
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
