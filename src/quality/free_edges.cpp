// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "quality/assess.hpp"
#include "quality/nearest.hpp"

namespace fexp::quality {

namespace {

/// Free edges nearer to each other than this part of their length are taken for a seam, if nearly parallel.
constexpr double seam_part = 0.05;
constexpr double least_seam_cosine = 0.9;

struct FreeEdge {
  Index element{};
  Vec3d start, end;  // [length]
  std::array<Index, 2> nodes{};

  [[nodiscard]] Vec3d middle() const noexcept { return 0.5 * (start + end); }
  [[nodiscard]] double length() const noexcept { return norm(end - start); }
};

std::vector<FreeEdge> all_free_edges(const model::Model& model) {
  std::vector<FreeEdge> edges;
  for (Index e = 0; e < model.element_count(); ++e) {
    for (std::size_t side = 0; side < 3; ++side) {
      if (model.is_free_edge(3 * e + static_cast<Index>(side))) {
        const Index a = model.triangle[at(e)][side], b = model.triangle[at(e)][(side + 1) % 3];
        edges.push_back({e, model.reference_position[at(a)], model.reference_position[at(b)], {a, b}});
      }
    }
  }
  return edges;
}

/// Distance from the middle of an edge to another edge that runs beside it, not both from the same node.
double seam_distance(const FreeEdge& edge, const FreeEdge& other) {
  const double length = edge.length(), other_length = other.length();
  const Vec3d along = other.end - other.start, way = edge.middle() - other.start;
  const double part = std::clamp(dot(way, along) / (other_length * other_length), 0.0, 1.0);
  const double distance = norm(way - part * along);
  const bool parallel = std::abs(dot(edge.end - edge.start, along)) >= least_seam_cosine * length * other_length;
  bool meet = false;
  for (const Index n : edge.nodes) {
    meet = meet || n == other.nodes[0] || n == other.nodes[1];
  }
  return parallel && !meet && distance <= seam_part * std::min(length, other_length) ? distance : HUGE_VAL;
}

std::vector<Finding> count_notes(const model::Model& model) {
  std::vector<Finding> findings;
  for (const Index b : first_copies(model)) {
    const model::Body& body = model.bodies[at(b)];
    Finding finding;
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      for (Index edge = 3 * e; edge < 3 * e + 3; ++edge) {
        if (model.is_free_edge(edge)) {
          add_item(finding, model.element_label[at(e)]);
        }
      }
    }
    if (finding.count > 0) {
      finding.ids.clear();  // All along the rim of a body that is open, as most are.
      finding.kind = "free_edges";
      finding.severity = Severity::note;
      finding.body = body.family;
      finding.item = "element";
      finding.message = fmt::format("{} free edges", finding.count);
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

}  // namespace

std::vector<Finding> free_edges(const model::Model& model) {
  std::vector<Finding> findings = count_notes(model);
  const std::vector<FreeEdge> edges = all_free_edges(model);
  std::vector<Vec3d> middle;
  std::vector<double> reach;
  for (const FreeEdge& edge : edges) {
    middle.push_back(edge.middle());
    reach.push_back((0.5 + seam_part) * edge.length());
  }
  contact::KdTree tree;
  tree.build(middle, reach);
  const auto box = [&](Index i) {
    Box point;
    point.include(middle[at(i)]);
    return point;
  };
  const auto body_of = [&](Index i) { return model.node_body[at(edges[at(i)].nodes[0])]; };
  const auto distance = [&](Index i, Index j) {
    return is_told(model, body_of(i), body_of(j)) ? seam_distance(edges[at(i)], edges[at(j)]) : HUGE_VAL;
  };
  const std::vector<Partner> partners = nearest_partners(tree, static_cast<Index>(edges.size()), box, distance);
  for (const PairGroup& group : group_pairs(model, partners, body_of)) {
    Finding finding = finding_of(model, group, [&](Index i) { return model.element_label[at(edges[at(i)].element)]; });
    finding.kind = "open_seam";
    finding.item = "element";
    finding.message = group.same_body ? fmt::format("{} pairs of free edges lie on each other without a node in common",
                                                    finding.count)
                                      : fmt::format("{} of its free edges lie on free edges of body \"{}\"",
                                                    finding.count, model.bodies[at(group.other_body)].family);
    finding.cure = group.same_body ? "it opens there as a seam that was not welded; merge the nodes in the mesh"
                                   : "bodies are not joined by that; if they are to hold together, make them parts "
                                     "of one mesh with the same nodes along the edge";
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
