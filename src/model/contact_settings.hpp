// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"

namespace fexp::model {

struct ContactSettings {
  bool enabled{true};
  bool self{true};            ///< Bodies touch themselves.
  bool edges{true};           ///< Edges touch edges.
  double friction{0.0};       ///< Coulomb's coefficient [-]
  double damping{0.0};        ///< Normal damping, as a part of the critical one of a pair [-]
  double penalty_scale{1.0};  ///< Factor on the stiffness that mass and first critical step give [-]
  double stiffness{-1.0};     ///< Penalty stiffness per pair [force/length]; negative: from the first critical step.
  std::vector<std::array<std::string, 2>> exclude;  ///< Pairs of bodies that do not touch; twice the same: itself.
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"enabled", "-", "Contact between all bodies.", &ContactSettings::enabled},
      Field{"self", "-", "Contact of each body with itself.", &ContactSettings::self},
      Field{"edges", "-", "Contact of edges with edges, besides that of nodes with elements.", &ContactSettings::edges},
      Field{"friction", "-", "Coulomb's coefficient of friction.", &ContactSettings::friction, non_negative},
      Field{"damping", "-", "Damping of the normal motion in contact, as a part of the critical damping of a pair.",
            &ContactSettings::damping, Range{0.0, 1.0, true, true, ">= 0 and <= 1"}},
      Field{"penalty_scale", "-", "Factor on the penalty stiffness that mass and first critical step give.",
            &ContactSettings::penalty_scale, positive},
      Field{"stiffness", "force/length",
            "Penalty stiffness of every pair; from the mass and the first critical step when left out.",
            &ContactSettings::stiffness, positive},
      Field{"exclude", "-", "Pairs of body names that do not touch; the same name twice: no self-contact.",
            &ContactSettings::exclude},
  };
};

}  // namespace fexp::model
