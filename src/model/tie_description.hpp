// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"

namespace fexp::model {

/// Nodes that are joined with the closest points of the triangles of other bodies.
struct TieDescription {
  std::string name;
  std::string set;
  std::vector<std::string> surface;  ///< Bodies whose triangles carry the nodes
  double distance{-1.0};             ///< [length]; negative: half thicknesses and a twentieth of them
  bool rotations{true};
  double strength_normal{-1.0};  ///< [force/length^2]; negative: it does not break
  double strength_shear{-1.0};   ///< Likewise
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name of the tie, for messages.", &TieDescription::name, any_number, Presence::required},
      Field{"set", "-",
            "Node set: the nodes that are tied. They have no conditions, and are not of rigid bodies nor of `surface`.",
            &TieDescription::set, any_number, Presence::required},
      Field{"surface", "-", "Bodies to whose triangles the nodes are tied, each to the closest one.",
            &TieDescription::surface, any_number, Presence::required},
      Field{"distance", "length",
            "How far a node may be from the surface; nodes farther away stay free. By default half the thickness of "
            "the node and of the surface together, and 5 % of that.",
            &TieDescription::distance, positive},
      Field{"rotations", "-", "Rotations are joined, too, as by a weld; else the nodes turn freely, as in a hinge.",
            &TieDescription::rotations},
      Field{"strength_normal", "force/length^2",
            "Stress across the joint, pulling, at which it breaks where there is no shear: the node's force over its "
            "share of the tied area. Without a strength ties hold for ever.",
            &TieDescription::strength_normal, positive},
      Field{"strength_shear", "force/length^2",
            "Stress along the joint at which it breaks where nothing pulls across it.", &TieDescription::strength_shear,
            positive},
  };
};

}  // namespace fexp::model
