// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "base/errors.hpp"
#include "base/field.hpp"
#include "base/vec3.hpp"
#include "model/contact_settings.hpp"
#include "model/mesh_generators.hpp"
#include "model/rigid_walls.hpp"
#include "model/run_settings.hpp"
#include "model/tie_description.hpp"
#include "physics/registry.hpp"
#include "physics/through_thickness.hpp"

/// What a user describes, before it is checked against meshes and frozen into a Model: plain values, each with its
/// documented fields and the place in the deck it came from.
namespace fexp::model {

/// Names of the degrees of freedom, in the order of FixedNode::mask and PrescribedNode::dof.
inline constexpr std::array<std::string_view, 6> dof_names{"x", "y", "z", "rx", "ry", "rz"};

/// Names of rules of integration through the thickness, in the order of physics::Quadrature.
inline constexpr std::array<std::string_view, 2> quadrature_names{"gauss", "lobatto"};

/// Piecewise linear function of time, constant beyond its ends.
struct Curve {
  std::string name;
  std::vector<std::array<double, 2>> points;  ///< (time, value), times ascending, shape [points]
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name by which loads and conditions refer to the curve.", &Curve::name, any_number,
            Presence::required},
      Field{"points", "time, -", "Pairs [time, value] with ascending times; constant beyond the ends.", &Curve::points,
            any_number, Presence::required},
  };
};

/// A material law with its parameters; the deck gives them in one table, which names the law's kind as `law`.
struct Material {
  std::string name;
  physics::AnyMaterial law;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name by which sections refer to the material.", &Material::name, any_number,
            Presence::required},
  };
};

struct Section {
  std::string name;
  std::string material;
  double thickness{};  ///< [length]
  Place place;
  int points{5};  ///< Through the thickness
  std::string quadrature{"gauss"};

  static constexpr Range points_range{1.0, physics::most_points, true, true, "1 to 9"};
  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name by which bodies refer to the section.", &Section::name, any_number, Presence::required},
      Field{"material", "-", "Name of a material.", &Section::material, any_number, Presence::required},
      Field{"thickness", "length", "Shell thickness.", &Section::thickness, positive, Presence::required},
      Field{"points", "-", "Integration points through the thickness of plastic laws; elastic ones need none.",
            &Section::points, points_range},
      Field{"quadrature", "-", "Where these points lie; Lobatto's rule has some on both surfaces and takes 3 or more.",
            &Section::quadrature, Choices(quadrature_names)},
  };
};

/// A mesh read from a file; the path is relative to the deck.
struct MeshFile {
  static constexpr std::string_view kind = "file";
  std::string path;
  double weld_tolerance{-1.0};  ///< [length]; negative: 1e-6 of the bounding box diagonal

  static constexpr auto fields = std::tuple{
      Field{"path", "-", "Mesh file (.msh, .stl, .obj), relative to the deck.", &MeshFile::path, any_number,
            Presence::required},
      Field{"weld_tolerance", "length", "STL nodes closer than this are one; by default 1e-6 of the box diagonal.",
            &MeshFile::weld_tolerance, non_negative},
  };
};

using AnyMesh = std::variant<MeshGenerator, MeshFile>;

struct Rotation {
  Vec3d axis{0.0, 0.0, 1.0};
  double angle_degrees{};
  Vec3d point{};  ///< Fixed point of the rotation [length]

  static constexpr auto fields = std::tuple{
      Field{"axis", "-", "Rotation axis (any length but zero).", &Rotation::axis, any_number, Presence::required},
      Field{"angle_degrees", "degree", "Angle by the right-hand rule.", &Rotation::angle_degrees, any_number,
            Presence::required},
      Field{"point", "length", "A point of the axis.", &Rotation::point},
  };
};

/// Copies of a body on a regular grid.
struct Array {
  std::array<int, 3> count{1, 1, 1};
  Vec3d pitch{};  ///< [length]

  static constexpr Range count_range{1.0, 1.0e7, true, true, "1 to 10000000 in each direction"};
  static constexpr auto fields = std::tuple{
      Field{"count", "-", "Number of copies in x, y and z.", &Array::count, count_range, Presence::required},
      Field{"pitch", "length", "Distance between copies in x, y and z.", &Array::pitch, any_number, Presence::required},
  };
};

/// Section of one part (physical group) of a body's mesh.
struct PartSection {
  std::string part;
  std::string section;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"part", "-", "Physical group (part) of the mesh.", &PartSection::part, any_number, Presence::required},
      Field{"section", "-", "Name of the section.", &PartSection::section, any_number, Presence::required},
  };
};

/// A set of elements that moves as a connected piece. Placement order: scale, rotations as listed, translate, array.
struct BodyDescription {
  std::string name;
  AnyMesh mesh;
  std::string section;  ///< Section of all parts that `parts` does not name; may be empty.
  std::vector<PartSection> parts;
  double scale{1.0};
  std::vector<Rotation> rotate;
  Vec3d translate{};  ///< [length]
  std::optional<Array> array;
  Vec3d velocity{};          ///< Initial velocity [length/time]
  Vec3d angular_velocity{};  ///< Initial angular velocity about the centre of mass [1/time]
  bool flip_normals{false};
  Place place;
  Place mesh_place;
  bool rigid{false};
  double mass{-1.0};  ///< Of the shells of a rigid body [mass]; negative: that of their material

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name of the body; copies of an array get [i,j,k] appended.", &BodyDescription::name,
            any_number, Presence::required},
      Field{"mesh", "-", "The mesh: made by a generator or read from a file.", &BodyDescription::mesh, any_number,
            Presence::required},
      Field{"section", "-", "Section of every part not listed in `parts`.", &BodyDescription::section},
      Field{"parts", "-", "Sections of single parts.", &BodyDescription::parts},
      Field{"scale", "-", "Factor on all coordinates of the mesh.", &BodyDescription::scale, positive},
      Field{"rotate", "-", "Rotations, applied in the order listed.", &BodyDescription::rotate},
      Field{"translate", "length", "Shift, applied after scale and rotations.", &BodyDescription::translate},
      Field{"array", "-", "Copies on a grid.", &BodyDescription::array},
      Field{"velocity", "length/time", "Initial velocity of all nodes.", &BodyDescription::velocity},
      Field{"angular_velocity", "1/time", "Initial angular velocity about the body's centre of mass.",
            &BodyDescription::angular_velocity},
      Field{"flip_normals", "-", "Turn all normals round.", &BodyDescription::flip_normals},
      Field{"rigid", "-",
            "The body moves with six degrees of freedom and does not deform. Conditions on it name all its nodes and "
            "mean its centre of mass and its rotation.",
            &BodyDescription::rigid},
      Field{"mass", "mass", "Of a rigid body: mass of its shells, each copy's, instead of that of their material.",
            &BodyDescription::mass, positive},
  };
};

/// Velocities of a node set at the start, besides those of its bodies and of other such tables.
struct InitialVelocity {
  std::string set;
  Vec3d velocity{};           ///< [length/time]
  double radial{};            ///< Away from the axis [length/time]
  Vec3d axis{0.0, 0.0, 1.0};  ///< Of `radial`
  Vec3d point{};              ///< A point of the axis [length]
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &InitialVelocity::set, any_number, Presence::required},
      Field{"velocity", "length/time", "Velocity of each node of the set.", &InitialVelocity::velocity},
      Field{"radial", "length/time", "Velocity away from an axis; negative: towards it.", &InitialVelocity::radial},
      Field{"axis", "-", "Direction of that axis (any length but zero).", &InitialVelocity::axis},
      Field{"point", "length", "A point of that axis.", &InitialVelocity::point},
  };
};

struct BoxSelection {
  Vec3d low{};
  Vec3d high{};

  static constexpr auto fields = std::tuple{
      Field{"low", "length", "Corner with the smallest coordinates.", &BoxSelection::low, any_number,
            Presence::required},
      Field{"high", "length", "Corner with the largest coordinates.", &BoxSelection::high, any_number,
            Presence::required},
  };
};

/// Named set of nodes: those of the named bodies (all when empty) that satisfy every selection given.
struct NodeSet {
  std::string name;
  std::vector<std::string> bodies;  ///< Body names as in the deck (an array's name means all its copies).
  bool boundary{false};             ///< Only nodes on free edges.
  std::optional<BoxSelection> box;  ///< Only nodes whose initial position lies inside, bounds included.
  std::string group;                ///< Only nodes of this physical group.
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"name", "-", "Name by which conditions and loads refer to the set.", &NodeSet::name, any_number,
            Presence::required},
      Field{"bodies", "-", "Bodies to choose from; all when left out.", &NodeSet::bodies},
      Field{"boundary", "-", "Only nodes on free edges.", &NodeSet::boundary},
      Field{"box", "length", "Only nodes whose initial position lies in the box.", &NodeSet::box},
      Field{"group", "-", "Only nodes of this physical group.", &NodeSet::group},
  };
};

/// Axes at an angle to those of the model: z = x cross `xy`, y = z cross x, each made a unit vector.
struct LocalAxes {
  Vec3d x{1.0, 0.0, 0.0};
  Vec3d xy{0.0, 1.0, 0.0};  ///< In the local xy plane, on the side of y

  static constexpr auto fields = std::tuple{
      Field{"x", "-", "Direction of the local x axis.", &LocalAxes::x, any_number, Presence::required},
      Field{"xy", "-", "A vector in the local xy plane, on the side of local y.", &LocalAxes::xy, any_number,
            Presence::required},
  };
};

/// Degrees of freedom held at rest: "x", "y", "z" translations, "rx", "ry", "rz" rotations.
struct Fixed {
  std::string set;
  std::vector<std::string> dofs{"x", "y", "z", "rx", "ry", "rz"};
  Place place;
  std::optional<LocalAxes> axes{};

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &Fixed::set, any_number, Presence::required},
      Field{"dofs", "-", "Which degrees of freedom are held: translations x, y, z, rotations rx, ry, rz.", &Fixed::dofs,
            Choices(dof_names)},
      Field{"axes", "-", "Axes of the degrees of freedom; those of the model when left out.", &Fixed::axes},
  };
};

/// Motion prescribed as scale x curve(time) on one degree of freedom, by one of velocity, displacement (from the
/// initial position) and acceleration (from the initial velocity); in radians for rotations.
struct Prescribed {
  std::string set;
  std::string dof;
  std::optional<double> velocity{};  ///< [length/time] or [1/time]
  std::string curve;                 ///< Factor in time; 1 when empty.
  Place place;
  std::optional<double> displacement{};  ///< [length] or [-]
  std::optional<double> acceleration{};  ///< [length/time^2] or [1/time^2]
  std::optional<LocalAxes> axes{};

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &Prescribed::set, any_number, Presence::required},
      Field{"dof", "-", "The degree of freedom that is moved.", &Prescribed::dof, Choices(dof_names),
            Presence::required},
      Field{"velocity", "length/time or 1/time", "Velocity, multiplied by the curve; or one of the two below.",
            &Prescribed::velocity},
      Field{"displacement", "length or -", "Displacement, multiplied by a curve that is zero at the start.",
            &Prescribed::displacement},
      Field{"acceleration", "length/time^2 or 1/time^2",
            "Acceleration, multiplied by the curve; it begins with the initial velocity.", &Prescribed::acceleration},
      Field{"curve", "-", "Factor in time; 1 when left out.", &Prescribed::curve},
      Field{"axes", "-", "Axes of the degree of freedom; those of the model when left out.", &Prescribed::axes},
  };
};

/// Mirror symmetry: no velocity along the normal, no rotation about axes in the plane.
struct Symmetry {
  std::string set;
  Vec3d normal{};
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &Symmetry::set, any_number, Presence::required},
      Field{"normal", "-", "Normal of the plane of symmetry.", &Symmetry::normal, any_number, Presence::required},
  };
};

struct Gravity {
  Vec3d acceleration{};  ///< [length/time^2]
  std::string curve;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"acceleration", "length/time^2", "Acceleration of free fall.", &Gravity::acceleration, any_number,
            Presence::required},
      Field{"curve", "-", "Factor in time; 1 when left out.", &Gravity::curve},
  };
};

/// Pressure on the current faces, positive against the normal (it pushes where the normal points away from).
struct Pressure {
  std::vector<std::string> bodies;
  std::string part;  ///< Only this part of the bodies' meshes; all when empty.
  double value{};    ///< [force/length^2]
  std::string curve;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"bodies", "-", "Bodies whose faces are loaded.", &Pressure::bodies, any_number, Presence::required},
      Field{"part", "-", "Only this part (physical group) of their meshes.", &Pressure::part},
      Field{"value", "force/length^2", "Pressure, acting against the face normals; follows the faces.",
            &Pressure::value, any_number, Presence::required},
      Field{"curve", "-", "Factor in time; 1 when left out.", &Pressure::curve},
  };
};

/// The same force and moment on every node of a set, or a total shared equally among them.
struct NodalForce {
  std::string set;
  Vec3d force{};   ///< [force]
  Vec3d moment{};  ///< [force*length]
  bool total{false};
  std::string curve;
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &NodalForce::set, any_number, Presence::required},
      Field{"force", "force", "Force on each node of the set.", &NodalForce::force},
      Field{"moment", "force*length", "Moment on each node of the set.", &NodalForce::moment},
      Field{"total", "-", "The values are totals, shared equally by the nodes of the set.", &NodalForce::total},
      Field{"curve", "-", "Factor in time; 1 when left out.", &NodalForce::curve},
  };
};

/// A mass, and an inertia alike about all axes, on every node of a set, or a total shared equally among them.
struct PointMass {
  std::string set;
  double mass{};     ///< [mass]
  double inertia{};  ///< [mass*length^2]
  bool total{false};
  Place place;

  static constexpr auto fields = std::tuple{
      Field{"set", "-", "Node set.", &PointMass::set, any_number, Presence::required},
      Field{"mass", "mass", "Mass added to each node of the set.", &PointMass::mass, non_negative, Presence::required},
      Field{"inertia", "mass*length^2", "Rotary inertia added to each node, the same about all axes.",
            &PointMass::inertia, non_negative},
      Field{"total", "-", "The values are totals, shared equally by the nodes of the set.", &PointMass::total},
  };
};

/// All the physics of a deck.
struct Description {
  RunSettings run;
  std::vector<Curve> curves;
  std::vector<Material> materials;
  std::vector<Section> sections;
  std::vector<BodyDescription> bodies;
  std::vector<NodeSet> node_sets;
  std::vector<InitialVelocity> initial_velocities;
  std::vector<Fixed> fixed;
  std::vector<Prescribed> prescribed;
  std::vector<Symmetry> symmetry;
  std::vector<Gravity> gravity;
  std::vector<Pressure> pressure;
  std::vector<NodalForce> forces;
  std::vector<PointMass> point_masses;
  std::vector<TieDescription> ties;
  std::vector<RigidPlane> planes;
  std::vector<RigidCylinder> cylinders;
  std::vector<RigidSphere> spheres;
  ContactSettings contact;
};

}  // namespace fexp::model
