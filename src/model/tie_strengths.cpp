// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "model/build_ties.hpp"

namespace fexp::model {

namespace {

/// The parts of tied nodes in the area of their joints.
class TiedAreas {
 public:
  explicit TiedAreas(const Model& model) : model_(model) {}

  /// [length^2]: a third of the elements at the node that are tied as a whole. Where there are none the node is of a
  /// seam: half of the edges that are, times the thickness there. One that is tied alone has a third of all its
  /// elements.
  [[nodiscard]] double of(const Tie& tie) const {
    const double face = thirds(tie, true);
    if (face > 0.0) {
      return face;
    }
    const double seam = half_edges(tie);
    return seam > 0.0 ? seam : thirds(tie, false);
  }

 private:
  [[nodiscard]] bool is_tied_alike(const Tie& tie, Index node) const {
    const Index other = model_.ties.tie_of(node);
    return other != no_index && model_.ties.ties[at(other)].description == tie.description;
  }

  [[nodiscard]] double thirds(const Tie& tie, bool tied_only) const {
    double sum = 0.0;
    for (Index c = model_.corner_start[at(tie.node)]; c < model_.corner_start[at(tie.node) + 1]; ++c) {
      const Index element = model_.corner[at(c)] / 3;
      const bool tied =
          std::ranges::all_of(model_.triangle[at(element)], [&](Index n) { return is_tied_alike(tie, n); });
      sum += tied || !tied_only ? model_.reference_area[at(element)] / 3.0 : 0.0;
    }
    return sum;
  }

  [[nodiscard]] double half_edges(const Tie& tie) const {
    std::vector<Index> ends;
    for (Index c = model_.corner_start[at(tie.node)]; c < model_.corner_start[at(tie.node) + 1]; ++c) {
      for (const Index n : model_.triangle[at(model_.corner[at(c)] / 3)]) {
        if (n != tie.node && is_tied_alike(tie, n)) {
          ends.push_back(n);
        }
      }
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    double sum = 0.0;
    for (const Index end : ends) {
      const double half = 0.5 * norm(model_.reference_position[at(end)] - model_.reference_position[at(tie.node)]);
      sum += half * 2.0 * std::min(model_.half_thickness[at(end)], model_.half_thickness[at(tie.node)]);
    }
    return sum;
  }

  const Model& model_;
};

}  // namespace

void give_strengths(const Description& description, Model& model) {
  const TiedAreas areas(model);
  for (Tie& tie : model.ties.ties) {
    const TieDescription& given = description.ties[at(tie.description)];
    if (!tie.breaks) {
      continue;
    }
    const double area = areas.of(tie);
    tie.normal_strength = given.strength_normal > 0.0 ? area * given.strength_normal : HUGE_VAL;
    tie.shear_strength = given.strength_shear > 0.0 ? area * given.strength_shear : HUGE_VAL;
  }
}

}  // namespace fexp::model
