// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.hpp"
#include "model/mesh.hpp"
#include "model/model.hpp"

namespace fexp::model {

/// Finds bodies by the names a deck may use: those of described bodies, which mean all copies, and those of copies.
class BodyNames {
 public:
  explicit BodyNames(const Model& model);

  /// Bodies of that name, ascending; none when there is no such name.
  [[nodiscard]] std::vector<Index> find(const std::string& name) const;
  /// Bodies of all the names, ascending; reports names that are not there. `user` says what names them.
  [[nodiscard]] std::vector<Index> find(std::span<const std::string> names, const Place& place, std::string_view user,
                                        ErrorList& errors) const;
  /// Names of described bodies, in their order.
  [[nodiscard]] const std::vector<std::string>& families() const noexcept { return families_; }

 private:
  const Model& model_;
  std::vector<std::string> families_;
};

/// Nodes that satisfy all selections of a set, ascending. A set without nodes and names that are not there are errors.
/// `body_groups` are those of the described bodies, by the numbers of nodes in them.
[[nodiscard]] std::vector<Index> select_nodes(const NodeSet& set, std::span<const std::vector<NodeGroup>> body_groups,
                                              const Model& model, const BodyNames& names, ErrorList& errors);

}  // namespace fexp::model
