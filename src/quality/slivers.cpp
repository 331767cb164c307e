// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "model/element_shares.hpp"
#include "quality/assess.hpp"
#include "quality/first_copies.hpp"

namespace fexp::quality {

namespace {

/// So few elements are looked at as the ones that may set the step alone: one in a thousand and ten at least, but not
/// more than one in ten.
std::size_t most_slivers(std::size_t elements) {
  return std::min(std::max(elements / 1000, std::size_t{10}), elements / 10);
}
/// How much longer the step has to be without them to be worth a word.
constexpr double least_gain = 1.5;

/// Smallest height of a triangle [length].
double height(const model::Model& model, Index e) {
  const auto& t = model.triangle[at(e)];
  double longest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    longest =
        std::max(longest, norm(model.reference_position[at(t[(c + 1) % 3])] - model.reference_position[at(t[c])]));
  }
  return 2.0 * model.reference_area[at(e)] / longest;
}

}  // namespace

std::vector<Finding> slivers(const model::Model& model) {
  std::vector<Index> elements;
  for (const Index b : first_copies(model)) {
    elements.resize(elements.size() + at(model.bodies[at(b)].elements.size()));
    std::iota(elements.end() - model.bodies[at(b)].elements.size(), elements.end(), model.bodies[at(b)].elements.begin);
  }
  const std::size_t most = most_slivers(elements.size());
  std::vector<double> step = model::element_shares(model).step;
  for (std::size_t e = 0; e < model.step_factor.size(); ++e) {
    step[e] *= model.step_factor[e];
  }
  std::partial_sort(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(most + 1), elements.end(),
                    [&](Index a, Index b) { return step[at(a)] != step[at(b)] ? step[at(a)] < step[at(b)] : a < b; });
  const double smallest = step[at(elements.front())], without = step[at(elements[most])];
  if (!(without >= least_gain * smallest)) {
    return {};
  }
  Finding finding;
  finding.kind = "slivers";
  finding.item = "element";
  const Index first = elements.front();
  const Index body = model.node_body[at(model.triangle[at(first)][0])];
  finding.body = model.bodies[at(body)].family;
  for (std::size_t i = 0; i < most && step[at(elements[i])] < without; ++i) {
    const Index owner = model.node_body[at(model.triangle[at(elements[i])][0])];
    if (owner != body) {
      finding.body.clear();  // Of several bodies
    }
    add_item(finding, model.element_label[at(elements[i])]);
  }
  const double safety = model.run.safety;
  finding.numbers = {{"step", safety * smallest}, {"step_without", safety * without}, {"height", height(model, first)}};
  finding.message = fmt::format(
      "the step is {:.4g}, set by {} of {} elements; without them it would be {:.4g}, {:.3g} times as long. The worst, "
      "element {} of body \"{}\", is {:.3g} high",
      safety * smallest, finding.count, elements.size(), safety * without, without / smallest,
      model.element_label[at(first)], model.bodies[at(body)].name, height(model, first));
  finding.cure = "remesh them, merge their nodes with those beside them, or give them mass with run.minimum_step";
  return {std::move(finding)};
}

}  // namespace fexp::quality
