// SPDX-License-Identifier: Apache-2.0
#include "io/similar_names.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

/// Least number of letters inserted, removed or replaced that turns one name into the other, whatever their case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower_case(a[i - 1]) == lower_case(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<std::string> similar_names(std::string_view wanted, std::span<const std::string> known) {
  constexpr std::size_t most = 3;
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(wanted, name);
    // A name of which nothing stays is another one.
    if (distance <= std::max<std::size_t>(2, wanted.size() / 3) && distance < wanted.size()) {
      near.emplace_back(distance, name);
    }
  }
  std::sort(near.begin(), near.end());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(near.size(), most); ++i) {
    names.push_back(near[i].second);
  }
  return names;
}

}  // namespace fexp::io
