// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/aligned_vector.hpp"
#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/contact_laws.hpp"
#include "model/description.hpp"
#include "model/ties.hpp"
#include "physics/drag.hpp"
#include "physics/layered_section.hpp"

namespace fexp::model {

/// Elements are stored in blocks of this many lanes, whatever width the kernels use, so that the layout of the state
/// does not depend on the processor.
inline constexpr Index block_lanes = 8;

/// Up to block_lanes consecutive elements of one body with one section.
struct ElementBlock {
  Index first{};  ///< First element; the block holds first .. first+count-1.
  Index count{};  ///< Used lanes; the rest repeats the last element and contributes nothing.
  Index section{};
  Index body{};
  Index layer_row{no_index};  ///< First row in State::layers; no_index where the section is elastic.
};

/// Material and thickness as the element kernel reads them.
struct SectionData {
  std::string name;
  physics::AnyMaterial law;
  physics::PlaneStressModuli moduli{};
  double density{};    ///< [mass/length^3]
  double thickness{};  ///< [length]
  physics::LayeredSection layered{};

  /// Rows of the history of an element's points.
  [[nodiscard]] Index layer_rows() const noexcept { return layered.rows(); }
};

/// A connected set of elements: the unit of the interaction graph, of energy sums, of hashes and of migration.
/// Its nodes, elements and blocks are contiguous, in ascending order of body.
struct Body {
  std::string name;
  std::string family;   ///< Name in the deck; copies of an array share it.
  Index description{};  ///< Index into Description::bodies.
  IndexRange nodes;
  IndexRange elements;
  IndexRange blocks;
  IndexRange fixed;        ///< Into Model::fixed.
  IndexRange prescribed;   ///< Into Model::prescribed.
  IndexRange symmetry;     ///< Into Model::symmetry.
  IndexRange oblique;      ///< Into Model::oblique.
  IndexRange pressure;     ///< Into Model::pressure.
  IndexRange forces;       ///< Into Model::forces.
  IndexRange ties;         ///< Into Ties::ties: its nodes that are tied
  IndexRange tied_blocks;  ///< Into Ties::blocks
  bool barrier{};          ///< Every node is held in all degrees of freedom: part of every island, joins none.
  double mass{};           ///< [mass]
  Index rigid{no_index};   ///< Into Model::rigid_bodies; no_index when the body deforms.
  /// Density of the elements over that of their material; not 1 in a rigid body whose mass is given.
  double density_factor{1.0};
  /// Into Model::walls where the body is a rigid wall with mass: one node, at the wall's point, and no elements.
  Index wall{no_index};
};

/// Degrees of freedom of one node held at rest; bit d is degree of freedom d (x y z rx ry rz).
struct FixedNode {
  Index node{};
  std::uint8_t mask{};
};

/// A direction at an angle to the axes in which a node does not move, or about which it does not turn.
struct ObliqueNode {
  Index node{};
  Vec3d direction{};  ///< Unit vector, orthogonal to all other directions that are held at the node
  bool angular{};
};

/// What of a motion is prescribed.
enum class PrescribedKind : std::uint8_t { velocity, displacement, acceleration };

/// A motion that is prescribed at a node; in RigidBody::prescribed that of the whole body, of which it names the first
/// node.
struct PrescribedNode {
  Index node{};
  std::int8_t dof{};  ///< 0..5: translations from 0, rotations from 3
  PrescribedKind kind{};
  bool oblique{};  ///< `direction` is not that of an axis of the model
  double value{};  ///< Times the curve [length/time^k] or [1/time^k], k = 1, 0, 2 by kind
  Index curve{no_index};
  Vec3d direction{};  ///< Unit vector

  [[nodiscard]] bool angular() const noexcept { return dof >= 3; }
};

/// A body that moves with six degrees of freedom: translations of its centre of mass, and its rotation.
struct RigidBody {
  Index body{};
  double mass{};                    ///< [mass]
  Vec3d centre;                     ///< Of mass, in the reference configuration [length]
  std::array<double, 3> inertia{};  ///< Principal moments about the centre, ascending [mass*length^2]
  std::array<Vec3d, 3> axis{};      ///< Principal axes in the reference configuration, a right-handed frame
  double radius{};                  ///< Of the farthest node from the centre [length]
  /// Largest ratio of the inertia of the nodes' masses to that of the body, >= 1: penalty springs, whose bound of
  /// omega^2 is made for the masses of nodes, may be stiffer on the body by this factor.
  double inertia_ratio{1.0};
  Vec3d initial_velocity;                  ///< [length/time]
  Vec3d initial_rotation_rate;             ///< [1/time]
  std::vector<Vec3d> held;                 ///< Orthogonal unit vectors along which the centre does not move
  std::vector<Vec3d> held_rotations;       ///< Orthogonal unit vectors about which the body does not turn
  std::vector<PrescribedNode> prescribed;  ///< Orthogonal to what is held and to each other
  bool turns_freely{true};                 ///< No rotation is held or prescribed
  bool prescribes_rotation{};
};

struct SymmetryNode {
  Index node{};
  Vec3d normal{};  ///< Unit vector.
};

struct PressureLoad {
  Index element{};
  double value{};  ///< [force/length^2]
  Index curve{no_index};
};

struct NodeLoad {
  Index node{};
  Vec3d force{};   ///< [force]
  Vec3d moment{};  ///< [force*length]
  Index curve{no_index};
};

/// Mass and isotropic inertia on a node besides those of its elements; part of Model::mass and Model::inertia.
struct AddedNode {
  Index node{};
  double mass{};     ///< [mass]
  double inertia{};  ///< [mass*length^2]
};

struct GravityLoad {
  Vec3d acceleration{};  ///< [length/time^2]
  Index curve{no_index};
};

enum class WallShape : std::uint8_t { plane, cylinder, sphere };

/// A surface that nodes do not pass.
struct Wall {
  std::string name;
  Vec3d point{};           ///< Of a plane, of the axis of a cylinder, or the centre, at time zero [length]
  Vec3d direction{};       ///< Unit vector: normal of a plane, towards the free side, or axis of a cylinder
  double radius{};         ///< [length]
  double stiffness{-1.0};  ///< Penalty stiffness per node [force/length]; negative: that of the node
  Vec3d motion{};          ///< Times the curve [length/time] or [length]
  physics::DragLaw drag{};
  double inverse_mass{};  ///< [1/mass]; 0: it stands or moves as told, whatever pushes it
  /// Of a wall with mass: c^2 M/dt^2 like that of a node, in series with which it is the stiffness where none is given.
  double mass_stiffness{};
  /// Of a wall with mass: largest edge of the box of all bodies in the reference configuration, as a size to go by
  /// [length].
  double span{};
  Index curve{no_index};
  Index rubbing{no_index};  ///< Its number among the walls with friction or damping; no_index where it has none
  Index body{no_index};     ///< That carries it, where it has a mass
  WallShape shape{};
  PrescribedKind kind{};  ///< Velocity or displacement
  bool inside{};          ///< Of cylinders and spheres: nodes stay inside.
  bool moves{};           ///< As told
};

struct NamedNodes {
  std::string name;
  std::vector<Index> nodes;  ///< Ascending.
};

/// The frozen model: everything that does not change during a run. Built by build_model, read by everyone.
struct Model {
  // Nodes, shape [nodes]
  std::vector<Vec3d> reference_position;     ///< Initial positions X [length]
  std::vector<Vec3d> initial_velocity;       ///< [length/time]
  std::vector<Vec3d> initial_rotation_rate;  ///< [1/time]
  std::vector<double> mass;                  ///< Lumped mass [mass]
  std::vector<double> inertia;               ///< Lumped isotropic, scaled rotary inertia [mass*length^2]
  std::vector<double> half_thickness;        ///< Half of the thickest shell at the node [length]
  /// Penalty stiffness of the node, c^2 m / dt^2 with the first critical step or E t/2, times penalty_scale
  /// [force/length]. A pair's stiffness is the series combination of its node and the triangle's corners by their
  /// weights, unless its law has one.
  std::vector<double> contact_stiffness;
  std::vector<double> node_size;  ///< Square root of the smallest element area at the node [length]
  std::vector<Index> node_body;
  std::vector<Index> corner_start;       ///< CSR over nodes, shape [nodes + 1]
  std::vector<Index> corner;             ///< 3 x element + corner, ascending within a node, shape [3 x elements]
  std::vector<std::int64_t> node_label;  ///< The user's id of the node.

  // Elements, shape [elements]
  std::vector<std::array<Index, 3>> triangle;   ///< Corner nodes
  std::vector<std::array<Index, 3>> neighbour;  ///< Element across edge (a, a+1), or no_index
  /// Edges (3 x element + edge) and corners, see edge_rounds and corner_fans; empty unless more than two elements meet
  /// at some edge.
  std::vector<Index> next_at_edge;
  std::vector<Index> corner_fan;
  std::vector<Index> element_block;
  std::vector<Index> element_part;          ///< Part (physical group) index within the body's mesh
  std::vector<double> reference_area;       ///< [length^2]
  std::vector<std::int64_t> element_label;  ///< The user's id of the element.
  /// Critical step with the mass that mass scaling gave the element over that without, >= 1; its mass is the square of
  /// this times that of the material. Empty when no element got any.
  std::vector<double> step_factor;

  std::vector<ElementBlock> blocks;
  std::vector<SectionData> sections;
  std::vector<Body> bodies;                          ///< Rigid walls with mass come after all others
  std::vector<RigidBody> rigid_bodies;               ///< In order of bodies
  std::vector<std::vector<std::string>> part_names;  ///< Of the described bodies' meshes, by element_part

  // Conditions and loads, each sorted by node or element; a body's own lie in the ranges its Body names.
  std::vector<FixedNode> fixed;
  std::vector<PrescribedNode> prescribed;
  std::vector<SymmetryNode> symmetry;
  std::vector<ObliqueNode> oblique;  ///< Applied after fixed and symmetry
  std::vector<PressureLoad> pressure;
  std::vector<NodeLoad> forces;
  std::vector<GravityLoad> gravity;
  std::vector<AddedNode> point_masses;
  Ties ties;
  std::vector<Curve> curves;
  std::vector<std::vector<double>> curve_areas;  ///< Integral of each curve from its first point to each of them [time]
  std::vector<Wall> walls;                       ///< Planes, cylinders and spheres of the deck
  Index rubbing_walls{};                         ///< Those with friction or damping
  std::vector<NamedNodes> node_sets;

  bool plastic{};   ///< Some section has points through its thickness.
  bool can_fail{};  ///< Elements may be deleted.
  ContactSettings contact;
  ContactLaws contact_laws;
  /// Pairs of bodies (first <= second, sorted) that do not touch.
  std::vector<std::pair<Index, Index>> excluded_pairs;
  RunSettings run;
  /// Smallest element critical step in the reference state, without damping [time]
  double first_critical_step{};
  Index first_critical_element{};  ///< The element that sets it

  /// Step that the elements allow in the reference state, with their damping and run.safety [time].
  [[nodiscard]] double first_step() const noexcept;
  [[nodiscard]] Index node_count() const noexcept { return static_cast<Index>(reference_position.size()); }
  [[nodiscard]] Index element_count() const noexcept { return static_cast<Index>(triangle.size()); }
  [[nodiscard]] Index body_count() const noexcept { return static_cast<Index>(bodies.size()); }
  /// Bodies that have a mesh, which are all but rigid walls with mass.
  [[nodiscard]] Index meshed_body_count() const noexcept;
  [[nodiscard]] Index block_count() const noexcept { return static_cast<Index>(blocks.size()); }
  [[nodiscard]] const SectionData& section_of(Index element) const {
    return sections[at(blocks[at(element_block[at(element)])].section)];
  }
  /// Mass of an element over that of its material.
  [[nodiscard]] double mass_factor(Index element) const noexcept {
    return step_factor.empty() ? 1.0 : step_factor[at(element)] * step_factor[at(element)];
  }
  /// What the acceleration of a node moves as long as no tie breaks, see model::moving_mass(model, state, node): its
  /// mass [mass] and inertia [mass*length^2] unless ties give it more or take them away.
  [[nodiscard]] double moving_mass(Index node) const noexcept {
    return ties.empty() ? mass[at(node)] : ties.mass[at(node)];
  }
  [[nodiscard]] double moving_inertia(Index node) const noexcept {
    return ties.empty() ? inertia[at(node)] : ties.inertia[at(node)];
  }
  /// True when bodies a and b (which may be the same) can touch by the deck's contact settings.
  [[nodiscard]] bool can_touch(Index a, Index b) const noexcept;
  /// Whether no other element is at the edge (3 x element + edge).
  [[nodiscard]] bool is_free_edge(Index edge) const noexcept {
    return next_at_edge.empty() ? neighbour[at(edge / 3)][at(edge % 3)] == no_index : next_at_edge[at(edge)] == edge;
  }
};

/// Calls visit(other) for every other element at the edge (3 x element + edge).
template <class Visit>
void for_each_at_edge(const Model& model, Index edge, const Visit& visit) {
  if (model.next_at_edge.empty()) {
    const Index other = model.neighbour[at(edge / 3)][at(edge % 3)];
    if (other != no_index) {
      visit(other);
    }
    return;
  }
  for (Index next = model.next_at_edge[at(edge)]; next != edge; next = model.next_at_edge[at(next)]) {
    visit(next / 3);
  }
}

/// Centre of the masses of a body's nodes in the reference configuration [length].
[[nodiscard]] Vec3d centre_of_mass(const Model& model, const Body& body);

/// How far beyond contact distance a node's side of a triangle is remembered [length], from the size of its elements. A
/// step carries a node by v dt, which is less than this part of its elements at any speed below a tenth of that of
/// sound.
[[nodiscard]] constexpr double watch_margin(double node_size) noexcept { return 0.15 * node_size; }

[[nodiscard]] double value_of(const Curve& curve, double time) noexcept;

/// Value of curve `index` at `time`; 1 when index is no_index.
[[nodiscard]] double curve_value(const Model& model, Index index, double time) noexcept;

/// Its slope [1/time], at a corner the mean of both sides; no times are twice in the curve.
[[nodiscard]] double curve_slope(const Model& model, Index index, double time) noexcept;

/// Its integral from time zero [time].
[[nodiscard]] double curve_integral(const Model& model, Index index, double time) noexcept;

}  // namespace fexp::model
