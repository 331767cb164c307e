// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.hpp"
#include "base/vec3.hpp"

/// What checks of several parts of a description need.
namespace fexp::model {

[[nodiscard]] inline bool has_direction(const Vec3d& v) {
  const double length = norm(v);
  return length > 0.0 && std::isfinite(length);
}

template <class Named>
[[nodiscard]] std::vector<std::string> names_of(const std::vector<Named>& items) {
  std::vector<std::string> names;
  for (const Named& item : items) {
    names.push_back(item.name);
  }
  return names;
}

/// Every name is given once and is not empty; `reserved` counts as given.
template <class Named>
void check_names(std::string_view kind, const std::vector<Named>& items, std::set<std::string> reserved,
                 ErrorList& errors) {
  for (const Named& item : items) {
    if (item.name.empty()) {
      errors.add(item.place, fmt::format("this {} has no name", kind), "a name of its own", "give it a name");
    } else if (!reserved.insert(item.name).second) {
      errors.add(item.place, fmt::format("the name \"{}\" is already that of another {}", item.name, kind),
                 "a name of its own", "rename one of them");
    }
  }
}

}  // namespace fexp::model
