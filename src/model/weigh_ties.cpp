// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "model/build_ties.hpp"
#include "model/tie_motion.hpp"

namespace fexp::model {

namespace {

/// Of the masses that ties hand to a carrier.
struct HandedMoments {
  double first{};   ///< Sum of m r [mass*length]
  double second{};  ///< Sum of m r^2 [mass*length^2]
  bool breaks{};    ///< Some of them may break
};

/// Of every node by how much omega^2 may be larger there. A tied node of mass m at the end of an arm r has the energy
/// m |v + omega x r|^2 / 2; lumped at its carrier it is m v^2 + m r^2 omega^2, which leaves out the product of the two.
/// With M and J of the carrier altogether and the sum R of its shares of m r the ratio of both is at most
/// 1 + R / sqrt(M J). Several carriers have more energy than the point between them, by weights that sum to 1.
///
/// Where ties may break R, M and J are those of the ties that are left, and R^2 <= m q with their sums m of m and q of
/// m r^2. m/M and q/J are largest as long as all hold: 1 + sqrt(m/M q/J) is a bound for any of them, with J that of the
/// carrier itself and q.
std::vector<double> ratios_of(const Model& model) {
  std::vector<HandedMoments> handed(model.mass.size());
  std::vector<double> ratio(model.mass.size(), 1.0);
  for (const Tie& tie : model.ties.ties) {
    for (std::size_t a = 0; a < 3 && tie.rigid == no_index && !tie.held; ++a) {
      HandedMoments& sum = handed[at(tie.carrier[a])];
      sum.first += tie.weight[a] * model.mass[at(tie.node)] * tie.length;
      sum.second += tie.weight[a] * model.mass[at(tie.node)] * tie.length * tie.length;
      sum.breaks = sum.breaks || tie.breaks;
    }
  }
  for (std::size_t n = 0; n < ratio.size(); ++n) {
    if (handed[n].breaks) {
      const double mass = (model.ties.mass[n] - model.mass[n]) / model.ties.mass[n];
      ratio[n] += std::sqrt(mass * handed[n].second / (model.inertia[n] + handed[n].second));
    } else if (handed[n].first > 0.0) {
      ratio[n] += handed[n].first / std::sqrt(model.ties.mass[n] * model.ties.inertia[n]);
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
    if (!tie.held) {
      ties.mass[at(tie.node)] = 0.0;
      ties.inertia[at(tie.node)] -= tie.rotations ? model.inertia[at(tie.node)] : 0.0;
    }
    for_each_handed(model, tie, [&](Index carrier, double mass, double inertia) {
      ties.mass[at(carrier)] += mass;
      ties.inertia[at(carrier)] += inertia;
    });
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
