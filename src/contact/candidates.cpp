// SPDX-License-Identifier: Apache-2.0
#include "contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel.hpp"

namespace fexp::contact {

namespace {

constexpr Index piece_elements = 256;
constexpr Index point_grain = 4096;
/// Distances are rounded; a pair on the very border is taken.
constexpr double rounding = 1.0e-9;

}  // namespace

void CandidateSearch::assign(const model::Model& model, std::span<const Index> bodies) {
  nodes_.clear();
  elements_.clear();
  barriers_ = false;
  for (const Index index : bodies) {
    const model::Body& body = model.bodies[at(index)];
    barriers_ = barriers_ || body.barrier;
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      nodes_.push_back(n);
    }
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      elements_.push_back(e);
    }
  }
  reach_.resize(nodes_.size());
  parallel::for_each(node_count(), point_grain, [&](Index i) {
    const Index n = nodes_[at(i)];
    reach_[at(i)] = (model.half_thickness[at(n)] + model::watch_margin(model.node_size[at(n)])) * (1.0 + rounding);
  });
  points_.resize(nodes_.size());
  pairs_.resize((elements_.size() + piece_elements - 1) / piece_elements);
}

void CandidateSearch::search(const model::Model& model, const Positions& x, double skin,
                             std::span<const Index> remembered, Candidates& found) {
  parallel::for_each(node_count(), point_grain, [&](Index i) { points_[at(i)] = x(nodes_[at(i)]); });
  if (barriers_) {
    take_points(model, skin);
    tree_.build(near_points_, near_reach_);
  } else {
    tree_.build(points_, reach_);
  }
  query(model, x, skin);
  fill_rows(remembered, found);
}

/// Barriers do not touch each other: of their nodes only those near other bodies are looked for. A barrier may be far
/// larger than the island.
void CandidateSearch::take_points(const model::Model& model, double skin) {
  const auto is_free = [&](std::size_t i) { return !model.bodies[at(model.node_body[at(nodes_[i])])].barrier; };
  free_ = {};
  Box corners;
  double thickest = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_free(i)) {
      corners.include(points_[i]);
      thickest = std::max(thickest, model.half_thickness[at(nodes_[i])]);
      farthest = std::max(farthest, reach_[i]);
    }
  }
  free_ = corners.grown(farthest * (1.0 + rounding));
  const Box touched = corners.grown((thickest + skin) * (1.0 + 2.0 * rounding));
  near_.clear();
  near_points_.clear();
  near_reach_.clear();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_free(i) || touched.grown(reach_[i]).contains(points_[i])) {
      near_.push_back(static_cast<Index>(i));
      near_points_.push_back(points_[i]);
      near_reach_.push_back(reach_[i]);
    }
  }
}

void CandidateSearch::query(const model::Model& model, const Positions& x, double skin) {
  parallel::for_each(static_cast<Index>(pairs_.size()), 1, [&](Index piece) {
    std::vector<Pair>& pairs = pairs_[at(piece)];
    pairs.clear();
    const Index end = std::min((piece + 1) * piece_elements, static_cast<Index>(elements_.size()));
    for (Index k = piece * piece_elements; k < end; ++k) {
      const Index element = elements_[at(k)];
      if (!x.has(model, element)) {
        continue;
      }
      const auto& t = model.triangle[at(element)];
      const std::array<Vec3d, 3> corner{x(t[0]), x(t[1]), x(t[2])};
      Box box;
      for (const Vec3d& p : corner) {
        box.include(p);
      }
      box = box.grown((half_thickness_of(model, element) + skin) * (1.0 + rounding));
      if (barriers_ && !free_.overlaps(box) && model.bodies[at(body_of_element(model, element))].barrier) {
        continue;
      }
      tree_.query(box, [&](Index point) {
        const Index local = barriers_ ? near_[at(point)] : point;
        const Index node = nodes_[at(local)];
        // Most of what lies in the box are the element's own corners.
        if (node == t[0] || node == t[1] || node == t[2] || !may_touch(model, node, element)) {
          return;
        }
        const double watch = watch_distance(model, node, element) * (1.0 + rounding);
        const double distance =
            std::sqrt(physics::closest_point(points_[at(local)], corner[0], corner[1], corner[2]).distance2);
        const double slack = distance * (1.0 - rounding) - watch;
        if (slack <= skin) {
          pairs.push_back({local, element, slack});
        }
      });
    }
  });
}

/// Sorts the pairs by node; within a node they already ascend, because the pieces do.
void CandidateSearch::fill_rows(std::span<const Index> remembered, Candidates& found) {
  row_size_.assign(nodes_.size(), 0);
  for (const std::vector<Pair>& pairs : pairs_) {
    for (const Pair& pair : pairs) {
      ++row_size_[at(pair.local)];
    }
  }
  found.node.clear();
  found.start.assign(1, 0);
  std::size_t next = 0;
  for (std::size_t local = 0; local < nodes_.size(); ++local) {
    while (next < remembered.size() && remembered[next] < nodes_[local]) {
      ++next;
    }
    const bool kept = next < remembered.size() && remembered[next] == nodes_[local];
    if (row_size_[local] == 0 && !kept) {
      continue;
    }
    found.node.push_back(nodes_[local]);
    found.start.push_back(found.start.back() + row_size_[local]);
    // From now on the row of this node.
    row_size_[local] = static_cast<Index>(found.node.size()) - 1;
  }
  found.element.resize(at(found.start.back()));
  found.slack.assign(found.node.size(), HUGE_VAL);
  std::vector<Index> place(found.start.begin(), found.start.end() - 1);
  for (const std::vector<Pair>& pairs : pairs_) {
    for (const Pair& pair : pairs) {
      const std::size_t row = at(row_size_[at(pair.local)]);
      found.element[at(place[row]++)] = pair.element;
      found.slack[row] = std::min(found.slack[row], pair.slack);
    }
  }
}

}  // namespace fexp::contact
