// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "physics/closest_point.hpp"
#include "quality/assess.hpp"
#include "quality/nearest.hpp"

namespace fexp::quality {

namespace {

constexpr double least_cosine = 0.9;
/// Shells that just touch are no overlap, whatever rounding makes of their distance.
constexpr double touching_part = 0.999;
/// Nearer than this part of their contact distance, one shell lies in the other, as one that is there twice.
constexpr double coincident_part = 0.02;

/// What the search needs of all elements, shape [elements].
struct Plates {
  explicit Plates(const model::Model& model)
      : centre(model.triangle.size()), normal(model.triangle.size()), reach(model.triangle.size()) {
    parallel::for_each(model.element_count(), 4096, [&](Index e) {
      const auto& t = model.triangle[at(e)];
      const Vec3d &a = model.reference_position[at(t[0])], &b = model.reference_position[at(t[1])],
                  &c = model.reference_position[at(t[2])];
      const Vec3d area = cross(b - a, c - a), mean = (1.0 / 3.0) * (a + b + c);
      centre[at(e)] = mean;
      normal[at(e)] = (1.0 / norm(area)) * area;
      reach[at(e)] = std::max({norm(a - mean), norm(b - mean), norm(c - mean)}) + half_thickness(model, e);
    });
  }
  [[nodiscard]] static double half_thickness(const model::Model& model, Index e) {
    return 0.5 * model.section_of(e).thickness;
  }

  std::vector<Vec3d> centre, normal;
  std::vector<double> reach;
};

/// Whether a tie joins a corner of one element with one of the other.
bool are_tied(const model::Model& model, Index e, Index other) {
  const auto& s = model.triangle[at(e)];
  const auto& t = model.triangle[at(other)];
  return !model.ties.empty() && std::any_of(s.begin(), s.end(), [&](Index a) {
    return std::any_of(t.begin(), t.end(), [&](Index b) { return model.ties.are_joined(a, b); });
  });
}

}  // namespace

std::vector<Finding> overlapping_shells(const model::Model& model) {
  const Plates plates(model);
  contact::KdTree tree;
  tree.build(plates.centre, plates.reach);
  const auto body_of = [&](Index e) { return model.node_body[at(model.triangle[at(e)][0])]; };
  const auto contact_distance = [&](Index e, Index other) {
    return Plates::half_thickness(model, e) + Plates::half_thickness(model, other);
  };
  const auto box = [&](Index e) {
    Box point;
    point.include(plates.centre[at(e)]);
    return point.grown(Plates::half_thickness(model, e));
  };
  const auto distance = [&](Index e, Index other) {
    const Vec3d way = plates.centre[at(e)] - plates.centre[at(other)];
    const double limit = touching_part * contact_distance(e, other);
    if (std::abs(dot(way, plates.normal[at(other)])) >= limit ||
        std::abs(dot(plates.normal[at(e)], plates.normal[at(other)])) < least_cosine ||
        !is_told(model, body_of(e), body_of(other)) || share_node(model, e, other) || are_tied(model, e, other)) {
      return HUGE_VAL;
    }
    const auto& t = model.triangle[at(other)];
    const physics::ClosestPoint closest =
        physics::closest_point(plates.centre[at(e)], model.reference_position[at(t[0])],
                               model.reference_position[at(t[1])], model.reference_position[at(t[2])]);
    return closest.feature == physics::Feature::face ? std::sqrt(closest.distance2) : HUGE_VAL;
  };
  const std::vector<Partner> partners = nearest_partners(tree, model.element_count(), box, distance);

  std::vector<Finding> findings;
  for (const PairGroup& group : group_pairs(model, partners, body_of)) {
    Finding finding = finding_of(model, group, [&](Index e) { return model.element_label[at(e)]; });
    const auto& [first, second] = group.pairs.front();
    const double limit = contact_distance(first, second);
    const bool touch = model.can_touch(group.body, group.other_body);
    finding.kind = "overlapping_shells";
    finding.severity = touch || group.smallest < coincident_part * limit ? Severity::warning : Severity::note;
    finding.item = "element";
    finding.numbers = {{"smallest_distance", group.smallest}, {"contact_distance", limit}};
    finding.message = fmt::format(
        "{} pairs of elements{} overlap: they are as near as {:.4g}, half their thicknesses are {:.4g}", finding.count,
        group.same_body ? "" : fmt::format(" with body \"{}\"", model.bodies[at(group.other_body)].family),
        group.smallest, limit);
    finding.cure = group.smallest < coincident_part * limit ? "a shell may be there twice; remove one of them"
                   : touch ? "contact keeps them as near as that and pushes only when they come nearer; move them "
                             "apart to half the sum of their thicknesses"
                           : "";
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
