// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace fexp::model {

/// Looks sets and curves up by name while conditions are expanded; check_description has found them all.
class Lookup {
 public:
  explicit Lookup(const Model& model) : model_(model) {}

  [[nodiscard]] const std::vector<Index>& nodes(const std::string& set) const {
    const auto found = std::find_if(model_.node_sets.begin(), model_.node_sets.end(),
                                    [&](const NamedNodes& named) { return named.name == set; });
    assert(found != model_.node_sets.end());
    return found->nodes;
  }
  /// The curve of that name; none for an empty name.
  [[nodiscard]] Index curve(const std::string& name) const {
    const auto found = std::find_if(model_.curves.begin(), model_.curves.end(),
                                    [&](const Curve& curve) { return curve.name == name; });
    assert(name.empty() || found != model_.curves.end());
    return name.empty() ? no_index : static_cast<Index>(found - model_.curves.begin());
  }

 private:
  const Model& model_;
};

}  // namespace fexp::model
