// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::cluster {

/// What a static analysis sums over the nodes of one body at the end of an epoch.
struct RelaxationSums {
  double unbalanced{};    ///< a.M a of all degrees of freedom [force^2/mass]
  double kinetic{};       ///< v.M v of the same [force*length]
  double stiffness{};     ///< -d.M (a - a') with d the displacement since the epoch's start, a' then [force*length]
  double displacement{};  ///< d.M d [mass*length^2]
  double power{};         ///< v.M a, the rate of the kinetic energy [force*length/time]

  RelaxationSums& operator+=(const RelaxationSums& other) noexcept;
};

/// Of an epoch that is over.
struct EpochTimes {
  double end{};        ///< [time]
  double dt{};         ///< Of its steps [time]
  double loads_end{};  ///< When loads change no more [time]
};

/// `before`: the state at the epoch's start.
[[nodiscard]] RelaxationSums relaxation_sums(const model::Model& model, const model::State& before,
                                             const model::State& state, Index body);

/// Dynamic relaxation, with the damping of the next epoch found from what bodies tell of the last one.
///
/// Viscous damping [P. Underwood, Dynamic relaxation, in: Computational methods for transient analysis (1983) 245-265]
/// is mass-proportional and critical for the frequency at which the model still moves, from the Rayleigh quotient of
/// the displacements in the epoch. As fast motion dies first, that frequency falls to the lowest one, whose motion
/// lasts longest. Deviation: the stiffness is that between the two ends of the epoch, from accelerations, instead of
/// one of each degree of freedom.
///
/// Kinetic damping [P. Cundall, Explicit finite-difference methods in geomechanics, 2nd Conf. Numerical Methods in
/// Geomechanics (1976) 132-150] brings all to rest at a peak of the kinetic energy: when it falls at the end of an
/// epoch. Epochs are short against the motion meanwhile.
///
/// The automatic choice does both, with little of the viscous damping. Where that does not lower the residual for long,
/// it goes on to kinetic, then to viscous damping alone, and around again, each time with twice the patience.
class Relaxation {
 public:
  /// Takes note of an epoch.
  void add(const RelaxationSums& sums, const model::RunSettings& run, const EpochTimes& times);

  /// Coefficient of damping for the next epoch, beside that of the deck [1/time].
  [[nodiscard]] double damping() const noexcept { return damping_; }
  /// Whether all is brought to rest before the next epoch.
  [[nodiscard]] bool stops() const noexcept { return stops_; }
  /// How long the next epoch may be, one step at least [time].
  [[nodiscard]] double longest_epoch() const noexcept { return longest_epoch_; }
  /// The larger of sqrt(a.M a) and sqrt(v.M v), each over the largest so far [-]. Both, as forces are balanced in
  /// passing, too.
  [[nodiscard]] double residual() const noexcept { return residual_; }
  /// Whether the residual is as small as it is to be and loads do not change any more.
  [[nodiscard]] bool settled() const noexcept { return settled_; }

 private:
  enum class Method { both, kinetic, viscous };

  void choose(double time, bool loaded);

  Method method_{Method::both};
  double frequency_{};  // At which the model moves [1/time]
  double damping_{};
  double longest_epoch_{HUGE_VAL};
  double time_{};  // Of the last epoch's end
  double largest_unbalanced_{};
  double largest_kinetic_{};
  double residual_{1.0};
  double least_residual_{HUGE_VAL};  // The last one that was progress
  double phase_{};                   // Of the motion since then [rad]
  double patience_{50.0};            // Largest phase without progress [rad]
  bool stops_{};
  bool settled_{};
};

/// When the last of the curves that loads and conditions follow has come to its end [time].
[[nodiscard]] double end_of_curves(const model::Model& model);

}  // namespace fexp::cluster
