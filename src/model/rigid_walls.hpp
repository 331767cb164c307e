// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <tuple>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "base/vec3.hpp"

/// What a user describes of surfaces that no node passes, standing or moving as told.
namespace fexp::model {

/// Meanings of the keys that all rigid walls have.
namespace wall_texts {
inline constexpr std::string_view stiffness =
    "Penalty stiffness per node; from the mass and the first critical step when left out.";
inline constexpr std::string_view velocity = "Its velocity, multiplied by the curve; or the displacement below.";
inline constexpr std::string_view displacement = "Its displacement, multiplied by a curve that is zero at the start.";
inline constexpr std::string_view curve = "Factor in time on its motion; 1 when left out.";
}  // namespace wall_texts

/// Rigid wall: a half space that nodes cannot enter. It belongs to every island and joins none.
struct RigidPlane {
  std::string name;
  Vec3d point{};           ///< [length]
  Vec3d normal{};          ///< Points to the free side; normalised when the model is built.
  double stiffness{-1.0};  ///< Penalty stiffness per node [force/length]; negative: from the first critical step.
  Place place;
  Vec3d velocity{};      ///< Times the curve [length/time]
  Vec3d displacement{};  ///< Times the curve [length]
  std::string curve;     ///< Factor in time; 1 when empty.

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name used in histories.", &RigidPlane::name, any_number, Presence::required},
      Field{"point", "length", "A point of the plane.", &RigidPlane::point, any_number, Presence::required},
      Field{"normal", "-", "Normal, pointing to the free side.", &RigidPlane::normal, any_number, Presence::required},
      Field{"stiffness", "force/length", wall_texts::stiffness, &RigidPlane::stiffness, positive},
      Field{"velocity", "length/time", wall_texts::velocity, &RigidPlane::velocity},
      Field{"displacement", "length", wall_texts::displacement, &RigidPlane::displacement},
      Field{"curve", "-", wall_texts::curve, &RigidPlane::curve},
  };
};

/// Rigid wall: the surface of an endless round cylinder, on one side of which nodes stay.
struct RigidCylinder {
  std::string name;
  Vec3d point{};    ///< Of the axis [length]
  Vec3d axis{};     ///< Normalised when the model is built.
  double radius{};  ///< [length]
  bool inside{false};
  double stiffness{-1.0};  ///< As that of a plane
  Place place;
  Vec3d velocity{};      ///< Times the curve [length/time]
  Vec3d displacement{};  ///< Times the curve [length]
  std::string curve;     ///< Factor in time; 1 when empty.

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name used in histories.", &RigidCylinder::name, any_number, Presence::required},
      Field{"point", "length", "A point of the axis.", &RigidCylinder::point, any_number, Presence::required},
      Field{"axis", "-", "Direction of the axis.", &RigidCylinder::axis, any_number, Presence::required},
      Field{"radius", "length", "Its radius.", &RigidCylinder::radius, positive, Presence::required},
      Field{"inside", "-", "Nodes stay inside; outside when left out.", &RigidCylinder::inside},
      Field{"stiffness", "force/length", wall_texts::stiffness, &RigidCylinder::stiffness, positive},
      Field{"velocity", "length/time", wall_texts::velocity, &RigidCylinder::velocity},
      Field{"displacement", "length", wall_texts::displacement, &RigidCylinder::displacement},
      Field{"curve", "-", wall_texts::curve, &RigidCylinder::curve},
  };
};

/// Rigid wall: the surface of a sphere, on one side of which nodes stay.
struct RigidSphere {
  std::string name;
  Vec3d centre{};   ///< [length]
  double radius{};  ///< [length]
  bool inside{false};
  double stiffness{-1.0};  ///< As that of a plane
  Place place;
  Vec3d velocity{};      ///< Times the curve [length/time]
  Vec3d displacement{};  ///< Times the curve [length]
  std::string curve;     ///< Factor in time; 1 when empty.

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name used in histories.", &RigidSphere::name, any_number, Presence::required},
      Field{"centre", "length", "Its centre.", &RigidSphere::centre, any_number, Presence::required},
      Field{"radius", "length", "Its radius.", &RigidSphere::radius, positive, Presence::required},
      Field{"inside", "-", "Nodes stay inside; outside when left out.", &RigidSphere::inside},
      Field{"stiffness", "force/length", wall_texts::stiffness, &RigidSphere::stiffness, positive},
      Field{"velocity", "length/time", wall_texts::velocity, &RigidSphere::velocity},
      Field{"displacement", "length", wall_texts::displacement, &RigidSphere::displacement},
      Field{"curve", "-", wall_texts::curve, &RigidSphere::curve},
  };
};

}  // namespace fexp::model
