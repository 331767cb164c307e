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
#include "base/vec3.hpp"

/// What a user describes of surfaces that no node passes: they stand, move as told, or have a mass and move by what
/// pushes them.
namespace fexp::model {

/// Names of the directions in which a wall with mass may be free.
inline constexpr std::array<std::string_view, 3> direction_names{"x", "y", "z"};

/// What all rigid walls have: surfaces that nodes cannot pass.
struct RigidWall {
  std::string name{};
  double stiffness{-1.0};            ///< Penalty stiffness per node [force/length]; negative: that of the node.
  std::optional<double> friction{};  ///< Coulomb's coefficient [-]; none: that of contact.
  std::optional<double> damping{};   ///< Part of the critical damping of a node [-]; none: that of contact.
  Vec3d velocity{};                  ///< Times the curve [length/time]
  Vec3d displacement{};              ///< Times the curve [length]
  std::string curve{};               ///< Factor in time, on the force of a wall with mass; 1 when empty.
  double mass{-1.0};                 ///< [mass]; negative: none, it stands or moves as told.
  Vec3d initial_velocity{};          ///< Of a wall with mass [length/time]
  Vec3d force{};                     ///< On a wall with mass, times the curve [force]
  std::optional<std::vector<std::string>> free{};  ///< Directions in which a wall with mass moves
  std::optional<Vec3d> guide{};                    ///< The one direction in which it moves (any length but zero)
  Place place{};

  static constexpr auto name_field =
      std::tuple{Field{"name", "-", "Name used in histories.", &RigidWall::name, any_number, Presence::required}};
  static constexpr auto other_fields = std::tuple{
      Field{"stiffness", "force/length",
            "Penalty stiffness per node; that which the node has in contact when left out.", &RigidWall::stiffness,
            positive},
      Field{"friction", "-", "Coulomb's coefficient of friction; that of `[contact]` when left out.",
            &RigidWall::friction, non_negative},
      Field{"damping", "-",
            "Damping of the normal motion, as a part of the critical damping of a node on the wall; that of "
            "`[contact]` when left out.",
            &RigidWall::damping, damping_range},
      Field{"velocity", "length/time", "Its velocity, multiplied by the curve; or the displacement below.",
            &RigidWall::velocity},
      Field{"displacement", "length", "Its displacement, multiplied by a curve that is zero at the start.",
            &RigidWall::displacement},
      Field{"curve", "-", "Factor in time on its motion, or on its force; 1 when left out.", &RigidWall::curve},
      Field{"mass", "mass",
            "Its mass: it moves by what pushes it, without turning, instead of as told. It counts as a body of one "
            "node, at its point, by its name.",
            &RigidWall::mass, positive},
      Field{"initial_velocity", "length/time", "Of a wall with mass: its velocity at the start.",
            &RigidWall::initial_velocity},
      Field{"force", "force", "Of a wall with mass: a force on it, multiplied by the curve.", &RigidWall::force},
      Field{"free", "-",
            "Of a wall with mass: the directions in which it moves; when left out, along the normal of a plane, across "
            "the axis of a cylinder, and all of a sphere.",
            &RigidWall::free, Choices(direction_names)},
      Field{"guide", "-", "Of a wall with mass, instead of `free`: the one direction in which it moves, at any angle.",
            &RigidWall::guide},
  };
};

/// A half space that nodes cannot enter.
struct RigidPlane : RigidWall {
  Vec3d point{};   ///< [length]
  Vec3d normal{};  ///< Points to the free side; normalised when the model is built.

  static constexpr auto fields = std::tuple_cat(
      name_field,
      std::tuple{
          Field{"point", "length", "A point of the plane.", &RigidPlane::point, any_number, Presence::required},
          Field{"normal", "-", "Normal, pointing to the free side.", &RigidPlane::normal, any_number,
                Presence::required},
      },
      other_fields);
};

/// The surface of an endless round cylinder, on one side of which nodes stay.
struct RigidCylinder : RigidWall {
  Vec3d point{};    ///< Of the axis [length]
  Vec3d axis{};     ///< Normalised when the model is built.
  double radius{};  ///< [length]
  bool inside{false};

  static constexpr auto fields = std::tuple_cat(
      name_field,
      std::tuple{
          Field{"point", "length", "A point of the axis.", &RigidCylinder::point, any_number, Presence::required},
          Field{"axis", "-", "Direction of the axis.", &RigidCylinder::axis, any_number, Presence::required},
          Field{"radius", "length", "Its radius.", &RigidCylinder::radius, positive, Presence::required},
          Field{"inside", "-", "Nodes stay inside; outside when left out.", &RigidCylinder::inside},
      },
      other_fields);
};

/// The surface of a sphere, on one side of which nodes stay.
struct RigidSphere : RigidWall {
  Vec3d centre{};   ///< [length]
  double radius{};  ///< [length]
  bool inside{false};

  static constexpr auto fields =
      std::tuple_cat(name_field,
                     std::tuple{
                         Field{"centre", "length", "Its centre.", &RigidSphere::centre, any_number, Presence::required},
                         Field{"radius", "length", "Its radius.", &RigidSphere::radius, positive, Presence::required},
                         Field{"inside", "-", "Nodes stay inside; outside when left out.", &RigidSphere::inside},
                     },
                     other_fields);
};

}  // namespace fexp::model
