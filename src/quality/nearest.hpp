// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "contact/kd_tree.hpp"
#include "model/model.hpp"
#include "parallel/parallel.hpp"
#include "quality/first_copies.hpp"

namespace fexp::quality {

/// The partner of an item and how far it is.
struct Partner {
  Index item{no_index};
  double distance{HUGE_VAL};  ///< [length]
};

/// For each of `count` items the nearest other one in the tree by distance(i, j), which is HUGE_VAL for what is no
/// partner, within box(i); the lowest of those as near. Shape [count].
template <class BoxOf, class Distance>
[[nodiscard]] std::vector<Partner> nearest_partners(const contact::KdTree& tree, Index count, const BoxOf& box,
                                                    const Distance& distance) {
  std::vector<Partner> partners(at(count));
  parallel::for_each(count, 1024, [&](Index i) {
    Partner nearest;
    tree.query(box(i), [&](Index j) {
      const double d = j == i ? HUGE_VAL : distance(i, j);
      if (d < nearest.distance || (d == nearest.distance && d < HUGE_VAL && j < nearest.item)) {
        nearest = {j, d};
      }
    });
    partners[at(i)] = nearest;
  });
  return partners;
}

/// Whether what two bodies have in common is to be told: within one body only of the first copy of a description.
[[nodiscard]] inline bool is_told(const model::Model& model, Index body, Index other) {
  return body != other || is_first_copy(model, body);
}

/// Pairs of items of the same two described bodies.
struct PairGroup {
  Index body{};
  Index other_body{};
  bool same_body{};  ///< Not two copies of an array
  double smallest{HUGE_VAL};
  std::vector<std::pair<Index, Index>> pairs;  ///< Items of body, of other_body
};

/// Gathers pairs by the described bodies they belong to, each pair of mutual partners once. `body_of(item)`.
template <class BodyOf>
[[nodiscard]] std::vector<PairGroup> group_pairs(const model::Model& model, const std::vector<Partner>& partners,
                                                 const BodyOf& body_of) {
  std::map<std::tuple<Index, Index, bool>, PairGroup> groups;
  for (std::size_t i = 0; i < partners.size(); ++i) {
    const auto item = static_cast<Index>(i);
    const Partner& partner = partners[i];
    if (partner.item == no_index || (partner.item < item && partners[at(partner.item)].item == item)) {
      continue;
    }
    std::pair<Index, Index> pair{item, partner.item};
    if (body_of(pair.first) > body_of(pair.second)) {
      std::swap(pair.first, pair.second);
    }
    const Index a = body_of(pair.first), b = body_of(pair.second);
    PairGroup& group = groups[{model.bodies[at(a)].description, model.bodies[at(b)].description, a == b}];
    if (group.pairs.empty()) {
      group.body = a;
      group.other_body = b;
      group.same_body = a == b;
    }
    group.smallest = std::min(group.smallest, partner.distance);
    group.pairs.push_back(pair);
  }
  std::vector<PairGroup> found;
  for (auto& [key, group] : groups) {
    found.push_back(std::move(group));
  }
  return found;
}

/// A finding about a group of pairs: its bodies, count, and the labels of the first pairs, ascending.
template <class LabelOf>
[[nodiscard]] Finding finding_of(const model::Model& model, const PairGroup& group, const LabelOf& label_of) {
  Finding finding;
  finding.body = model.bodies[at(group.body)].family;
  finding.other_body = group.same_body ? "" : model.bodies[at(group.other_body)].family;
  std::vector<std::pair<std::int64_t, std::int64_t>> labels;
  labels.reserve(group.pairs.size());
  for (const auto& [a, b] : group.pairs) {
    labels.emplace_back(label_of(a), label_of(b));
    if (group.same_body && labels.back().first > labels.back().second) {
      std::swap(labels.back().first, labels.back().second);
    }
  }
  std::sort(labels.begin(), labels.end());
  for (const auto& [a, b] : labels) {
    if (finding.ids.size() < most_ids) {
      finding.other_ids.push_back(b);
    }
    add_item(finding, a);
  }
  return finding;
}

/// Whether two elements have a node in common.
[[nodiscard]] inline bool share_node(const model::Model& model, Index a, Index b) {
  const auto &first = model.triangle[at(a)], &second = model.triangle[at(b)];
  return std::any_of(first.begin(), first.end(),
                     [&](Index n) { return n == second[0] || n == second[1] || n == second[2]; });
}

}  // namespace fexp::quality
