// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/model.hpp"
#include "model/state.hpp"
#include "solve/kernels.hpp"

namespace fexp::solve {

/// Energies of the model or of one body [force*length]. Kinetic energy, element energies and contact potentials are
/// computed independently of each other, so that their balance checks the solver.
struct Energies {
  double kinetic{};
  double internal{};    ///< Sum of the elements' stress work
  double contact{};     ///< Potential of contact pairs
  double barrier{};     ///< Potential of rigid walls
  double external{};    ///< Work put in by loads, gravity and prescribed motion
  double damping{};     ///< Work taken out by damping
  double dissipated{};  ///< Of the internal energy what plastic flow has taken
  double friction{};    ///< Taken by friction and damping of contact

  /// What the body has now, less what was put in: constant in exact arithmetic and time.
  [[nodiscard]] double balance() const noexcept {
    return kinetic + internal + contact + barrier + damping + friction - external;
  }
  Energies& operator+=(const Energies& other) noexcept;
};

struct Momenta {
  Vec3d linear;            ///< Sum of m v [force*time]
  Vec3d angular;           ///< Sum of x cross m v + I omega about the origin [force*length*time]
  double linear_scale{};   ///< Sum of |m v|
  double angular_scale{};  ///< Sum of |x cross m v| + |I omega|
  Vec3d external_impulse;  ///< Put in from outside since the start
  Vec3d external_angular_impulse;

  Momenta& operator+=(const Momenta& other) noexcept;
};

struct Diagnostics {
  Energies energies;
  Momenta momenta;
  std::int64_t deleted{};  ///< Elements that have failed
  /// Sum of m a.a + I alpha.alpha: dt^2/8 times this is what central differences take from the energy that they keep
  /// [mass*length^2/time^4].
  double acceleration_square{};

  Diagnostics& operator+=(const Diagnostics& other) noexcept;
};

/// Diagnostics of one body, summed in fixed pieces so that no number of threads changes a bit.
[[nodiscard]] Diagnostics body_diagnostics(const model::Model& model, const model::State& state, Index body);

/// Of these the kinetic energy, the momenta and the accelerations' square.
[[nodiscard]] Diagnostics motion_diagnostics(const model::Model& model, const model::State& state, Index body);

/// Sum over all bodies in ascending order.
[[nodiscard]] Diagnostics diagnostics(const model::Model& model, const model::State& state);

[[nodiscard]] constexpr CriticalStep smaller(const CriticalStep& a, const CriticalStep& b) noexcept {
  return b.step < a.step ? b : a;
}

/// Critical step over one body's elements in the current geometry. A rigid body has the model's first critical step, or
/// the one in which it turns by a fifth of a radian.
[[nodiscard]] CriticalStep body_critical_step(const model::Model& model, const model::State& state, Index body);

}  // namespace fexp::solve
