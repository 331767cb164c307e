// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "support/contact.hpp"

namespace fexp::test {

/// A set of all nodes of a body.
inline void name_nodes(model::Description& d, const std::string& set, const std::string& body) {
  d.node_sets.emplace_back().name = set;
  d.node_sets.back().bodies = {body};
}

inline model::TieDescription& tie(model::Description& d, const std::string& set, std::vector<std::string> surface) {
  model::TieDescription& t = d.ties.emplace_back();
  t.name = "tie " + std::to_string(d.ties.size());
  t.set = set;
  t.surface = std::move(surface);
  return t;
}

}  // namespace fexp::test
