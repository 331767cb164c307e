// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::cluster {

/// What a static analysis sums over the nodes of one body at the end of an epoch.
struct RelaxationSums {
  double unbalanced{};    ///< a.M a of all degrees of freedom [force^2/mass]
  double kinetic{};       ///< v.M v of the same [force*length]
  double stiffness{};     ///< -d.M (a - a') with d the displacement since the epoch's start, a' then [force*length]
  double displacement{};  ///< d.M d [mass*length^2]

  RelaxationSums& operator+=(const RelaxationSums& other) noexcept;
};

/// `before`: the state at the epoch's start.
[[nodiscard]] RelaxationSums relaxation_sums(const model::Model& model, const model::State& before,
                                             const model::State& state, Index body);

/// Dynamic relaxation [P. Underwood, Dynamic relaxation, in: Computational methods for transient analysis (1983)
/// 245-265]: motion under mass-proportional damping that is critical for the frequency at which the model still moves,
/// found anew after every epoch from the Rayleigh quotient of the displacements in it. As fast motion dies first, that
/// frequency falls to the lowest one, whose motion lasts longest. Deviation: the stiffness is that between the two
/// ends of the epoch, from accelerations, instead of one of each degree of freedom.
class Relaxation {
 public:
  /// Takes note of an epoch that ended at `time`.
  void add(const RelaxationSums& sums, const model::RunSettings& run, double time, double loads_end);

  /// Coefficient of damping for the next epoch, beside that of the deck [1/time].
  [[nodiscard]] double damping() const noexcept { return damping_; }
  /// The larger of sqrt(a.M a) and sqrt(v.M v), each over the largest so far [-]. Both, as forces are balanced in
  /// passing, too.
  [[nodiscard]] double residual() const noexcept { return residual_; }
  /// Whether the residual is as small as it is to be and loads do not change any more.
  [[nodiscard]] bool settled() const noexcept { return settled_; }

 private:
  double damping_{};
  double largest_unbalanced_{};
  double largest_kinetic_{};
  double residual_{1.0};
  bool settled_{};
};

/// When the last of the curves that loads and conditions follow has come to its end [time].
[[nodiscard]] double end_of_curves(const model::Model& model);

}  // namespace fexp::cluster
