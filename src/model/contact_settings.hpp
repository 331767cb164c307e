// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"

namespace fexp::model {

/// Settings of two bodies where they touch; what is left out is that of all.
struct ContactPair {
  /// Twice the same: the body with itself, and copies of an array with each other as well.
  std::array<std::string, 2> bodies{};
  std::optional<double> friction{};       ///< [-]
  std::optional<double> damping{};        ///< [-]
  std::optional<double> penalty_scale{};  ///< [-]
  std::optional<double> stiffness{};      ///< [force/length]
  Place place{};

  static constexpr auto fields = std::tuple{
      Field{"bodies", "-",
            "Names of two bodies; twice the same: the body with itself, and copies of an array with each other as "
            "well.",
            &ContactPair::bodies, any_number, Presence::required},
      Field{"friction", "-", "Coulomb's coefficient of friction.", &ContactPair::friction, non_negative},
      Field{"damping", "-", "Damping of the normal motion, as a part of the critical damping of a pair.",
            &ContactPair::damping, damping_range},
      Field{"penalty_scale", "-", "Factor on the penalty stiffness.", &ContactPair::penalty_scale, positive},
      Field{"stiffness", "force/length", "Penalty stiffness of every pair of node and element.",
            &ContactPair::stiffness, positive},
  };
};

struct ContactSettings {
  /// Where the penalty stiffness comes from.
  static constexpr std::array<std::string_view, 3> penalties{"step", "element", "given"};
  /// What becomes of shells that are nearer than their thicknesses allow at the start.
  static constexpr std::array<std::string_view, 2> treatments{"keep", "remove"};

  static constexpr double usual_hardening = 2.0;

  bool enabled{true};
  bool self{true};                    ///< Bodies touch themselves.
  bool edges{true};                   ///< Edges touch edges.
  double friction{0.0};               ///< Coulomb's coefficient [-]
  double damping{0.0};                ///< Normal damping, as a part of the critical one of a pair [-]
  std::string penalty{};              ///< One of `penalties`; empty: "given" with a stiffness, "step" without.
  double penalty_scale{1.0};          ///< Factor on the stiffness of nodes [-]
  std::optional<double> hardening{};  ///< How much stiffer contact becomes with depth [-]; none: `usual_hardening`,
                                      ///< or 0 where a stiffness is given.
  double stiffness{-1.0};             ///< Penalty stiffness per pair [force/length]; negative: none is given.
  std::vector<std::array<std::string, 2>> exclude;  ///< Pairs of bodies that do not touch; twice the same: itself.
  std::vector<ContactPair> pairs{};
  std::string initial_penetrations{"keep"};  ///< One of `treatments`
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"enabled", "-", "Contact between all bodies.", &ContactSettings::enabled},
      Field{"self", "-", "Contact of each body with itself.", &ContactSettings::self},
      Field{"edges", "-", "Contact of edges with edges, besides that of nodes with elements.", &ContactSettings::edges},
      Field{"friction", "-", "Coulomb's coefficient of friction.", &ContactSettings::friction, non_negative},
      Field{"damping", "-", "Damping of the normal motion in contact, as a part of the critical damping of a pair.",
            &ContactSettings::damping, damping_range},
      Field{"penalty", "-",
            "Where the penalty stiffness comes from: mass and first critical step (\"step\"), modulus and thickness of "
            "the shells (\"element\"), or `stiffness` (\"given\"). When left out: \"given\" with a `stiffness`, else "
            "\"step\".",
            &ContactSettings::penalty, Choices(penalties)},
      Field{"penalty_scale", "-", "Factor on the penalty stiffness of nodes.", &ContactSettings::penalty_scale,
            positive},
      Field{"hardening", "-",
            "How much stiffer contact becomes with depth: a pair at its full contact distance, where the mid-surfaces "
            "meet, has 1 + `hardening` times the energy of a linear penalty; 0: linear. When left out: 2, or 0 where a "
            "stiffness is given.",
            &ContactSettings::hardening, non_negative},
      Field{"stiffness", "force/length", "Penalty stiffness of every pair.", &ContactSettings::stiffness, positive},
      Field{"exclude", "-", "Pairs of body names that do not touch; the same name twice: no self-contact.",
            &ContactSettings::exclude},
      Field{"pairs", "-", "Settings of single pairs of bodies; what is left out is as above.", &ContactSettings::pairs},
      Field{
          "initial_penetrations", "-",
          "What becomes of shells that are nearer at the start than their thicknesses allow: they keep their distance "
          "without a force (\"keep\"), or their nodes are moved apart before the start, without stress (\"remove\").",
          &ContactSettings::initial_penetrations, Choices(treatments)},
  };
};

}  // namespace fexp::model
