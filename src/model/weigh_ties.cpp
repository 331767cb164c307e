// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "model/build_ties.hpp"

namespace fexp::model {

namespace {

/// Of every node by how much omega^2 may be larger there. A tied node of mass m at the end of an arm r has the energy
/// m |v + omega x r|^2 / 2; lumped at its carrier it is m v^2 + m r^2 omega^2, which leaves out the product of the two.
/// With M and J of the carrier altogether and the sum R of its shares of m r the ratio of both is at most
/// 1 + R / sqrt(M J). Several carriers have more energy than the point between them, by weights that sum to 1.
std::vector<double> ratios_of(const Model& model) {
  std::vector<double> first_moment(model.mass.size()), ratio(model.mass.size(), 1.0);
  for (const Tie& tie : model.ties.ties) {
    for (std::size_t a = 0; a < 3 && tie.rigid == no_index; ++a) {
      first_moment[at(tie.carrier[a])] += tie.weight[a] * model.mass[at(tie.node)] * tie.length;
    }
  }
  for (std::size_t n = 0; n < ratio.size(); ++n) {
    if (first_moment[n] > 0.0) {
      ratio[n] += first_moment[n] / std::sqrt(model.ties.mass[n] * model.ties.inertia[n]);
    }
  }
  for (const Tie& tie : model.ties.ties) {
    for (const Index carrier : tie.carrier) {
      ratio[at(tie.node)] = std::max(ratio[at(tie.node)], ratio[at(carrier)]);
    }
  }
  return ratio;
}

}  // namespace

void weigh_ties(Model& model) {
  Ties& ties = model.ties;
  if (ties.empty()) {
    return;
  }
  ties.mass = model.mass;
  ties.inertia = model.inertia;
  for (const Tie& tie : ties.ties) {
    const double mass = model.mass[at(tie.node)], inertia = tie.rotations ? model.inertia[at(tie.node)] : 0.0;
    ties.mass[at(tie.node)] = 0.0;
    ties.inertia[at(tie.node)] -= inertia;
    for (std::size_t a = 0; a < 3 && tie.rigid == no_index; ++a) {
      ties.mass[at(tie.carrier[a])] += tie.weight[a] * mass;
      ties.inertia[at(tie.carrier[a])] += tie.weight[a] * (inertia + mass * tie.length * tie.length);
    }
  }
  const std::vector<double> ratio = ratios_of(model);
  for (Index b = 0; b < model.block_count(); ++b) {
    const ElementBlock& block = model.blocks[at(b)];
    double largest = 1.0;
    for (Index e = block.first; e < block.first + block.count; ++e) {
      for (const Index n : model.triangle[at(e)]) {
        largest = std::max(largest, ratio[at(n)]);
      }
    }
    if (largest > 1.0) {
      ties.blocks.push_back({b, largest});
    }
  }
}

}  // namespace fexp::model
