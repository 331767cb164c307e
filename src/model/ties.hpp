// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"

/// Ties as they are frozen into a Model: a tied node is at the end of an arm that stands on a triangle and turns with
/// the corners of that.
namespace fexp::model {

/// A node that moves with the corners of a triangle of another body, its carriers: by weights that are not negative and
/// sum to 1, or with the whole body where that is rigid.
struct Tie {
  Index node{};
  std::array<Index, 3> carrier{};
  std::array<double, 3> weight{};
  double length{};        ///< Of the arm from the point of the triangle to the node [length]
  bool rotations{};       ///< The node turns with the carriers; else freely
  Index description{};    ///< Into Description::ties
  Index rigid{no_index};  ///< Into Model::rigid_bodies, where the carriers are of a rigid body
  bool held{};            ///< The carriers do not move: the node keeps its mass, and they are handed nothing
  bool breaks{};          ///< It has a strength
  bool conditions{};      ///< A condition acts on one of the carriers
  /// Largest forces along the normal of the triangle and across it [force]: its strengths times the node's share of the
  /// tied area.
  double normal_strength{HUGE_VAL};
  double shear_strength{HUGE_VAL};

  /// Whether the node is among those of Model::fixed, which hold it: for ever, as it does not break.
  [[nodiscard]] bool is_fixed() const noexcept { return held && !breaks; }
};

/// A block with elements at tied nodes or carriers. Where arms have a length the masses lumped at the carriers have
/// less energy in some motions than those of the tied nodes, by at most this ratio >= 1, and omega^2 is larger by it.
struct TiedBlock {
  Index block{};
  double ratio{};
};

/// Bodies that ties join.
struct TiedBodies {
  Index body{};     ///< Of tied nodes
  Index carrier{};  ///< Of their carriers
  double arm{};     ///< The longest [length]
};

/// What became of a table of the deck.
struct TieResult {
  std::string name;
  Index tied{};            ///< Nodes
  std::vector<Index> far;  ///< Nodes that are too far from the surface, ascending
  double distance{};       ///< Of the closest of those [length]
};

struct Ties {
  std::vector<Tie> ties;           ///< Ascending by node; a body's own lie in Body::ties.
  std::vector<TiedBlock> blocks;   ///< Ascending; a body's own lie in Body::tied_blocks.
  std::vector<TiedBodies> bodies;  ///< Ascending by both; none whose carriers are all held
  std::vector<TieResult> results;  ///< [tables of the deck]
  /// Nodes and their carriers, both ways, sorted: no contact between a node and triangles at nodes it is joined with.
  std::vector<std::pair<Index, Index>> joined;
  /// Masses and inertias that accelerations have to move at the start, shape [nodes]: of carriers with their shares of
  /// those of tied nodes, which have none left but the inertia where they turn freely. Empty without ties.
  std::vector<double> mass;
  std::vector<double> inertia;

  bool can_break{};  ///< Some tie has a strength

  [[nodiscard]] bool empty() const noexcept { return ties.empty(); }
  /// Whether a node is joined with another one as long as no tie breaks.
  [[nodiscard]] bool are_joined(Index a, Index b) const noexcept;
  /// The tie of a node; no_index where it has none.
  [[nodiscard]] Index tie_of(Index node) const noexcept;
};

}  // namespace fexp::model
