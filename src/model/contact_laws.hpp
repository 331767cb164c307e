// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/index.hpp"
#include "physics/drag.hpp"

namespace fexp::model {

/// How the surfaces of two bodies act on each other where they touch.
struct ContactLaw {
  physics::DragLaw drag;
  double stiffness{-1.0};  ///< Penalty stiffness of a pair [force/length]; negative: that of the nodes in series
  double scale{1.0};       ///< Factor on the stiffness of the nodes in series [-]
  double hardening{};      ///< See physics::penalty_of [-]
};

/// The laws of all pairs of bodies. Bodies that the deck names alike are a group.
struct ContactLaws {
  /// First that of all pairs which the deck does not name.
  std::vector<ContactLaw> laws = std::vector<ContactLaw>(1);
  std::vector<Index> group;   ///< [bodies]; empty where the deck names no pairs
  std::vector<Index> law_of;  ///< [groups][groups]
  Index groups{};
  bool drags{};  ///< Some law has friction or damping

  [[nodiscard]] const ContactLaw& of(Index a, Index b) const noexcept {
    return group.empty() ? laws.front() : laws[at(law_of[at(group[at(a)] * groups + group[at(b)])])];
  }
};

}  // namespace fexp::model
