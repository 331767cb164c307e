// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "model/model.hpp"

namespace fexp::model {

/// Local axes as unit vectors; without any those of the model.
[[nodiscard]] std::array<Vec3d, 3> unit_axes(const std::optional<LocalAxes>& axes);

/// Whether axes are those of the model, to the bit.
[[nodiscard]] bool are_model_axes(const std::array<Vec3d, 3>& axes) noexcept;

/// Calls visit for every item of a list sorted by node that is at the node.
template <class Item, class Visit>
void for_each_at(const std::vector<Item>& items, Index node, const Visit& visit) {
  const auto before = [](const Item& item, Index n) { return item.node < n; };
  for (auto item = std::lower_bound(items.begin(), items.end(), node, before);
       item != items.end() && item->node == node; ++item) {
    visit(*item);
  }
}

/// What the conditions that are in the model so far (fixed, symmetry, oblique) leave of a rate's direction at a node:
/// the direction itself where it is free, zero where it is held. The conditions must be sorted by node.
[[nodiscard]] Vec3d free_part(const Model& model, Index node, bool angular, const Vec3d& direction);

}  // namespace fexp::model
