// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "model/model.hpp"

/// Surfaces that are nearer to each other before the start than their thicknesses allow, or pass through each other.
namespace fexp::contact {

/// A node and an element that are nearer than contact distance, or two edges that cross.
struct InitialPenetration {
  Index first{};              ///< The node, or the lower edge
  Index second{};             ///< The element, or the higher edge
  bool of_edges{};            ///< Numbers of edges as those of model::EdgeSide
  double distance{};          ///< [length]
  double contact_distance{};  ///< Sum of both half thicknesses there [length]

  [[nodiscard]] double depth() const noexcept { return contact_distance - distance; }
};

/// An edge that passes through an element.
struct Crossing {
  Index edge{};
  Index element{};
};

struct InitialPenetrations {
  std::vector<InitialPenetration> pairs;  ///< Nodes with elements and then edges, ascending by (first, second)
  std::vector<Crossing> crossings;        ///< Ascending by (element, edge)
};

/// Those of two described bodies, or of a body with itself.
struct PenetratingBodies {
  Index body{};      ///< Of the deepest pair, or of the first crossing where no pair is deep: that of its first item
  Index other{};     ///< That of its second item
  bool same_body{};  ///< Not two copies of an array
  Index count{};     ///< Nodes, and pairs of edges
  InitialPenetration deepest;
  Index crossings{};
  Crossing first_crossing;
};

/// Finds them among the bodies that may touch, with the nodes at `position`. A pair that is nearer than contact
/// distance by rounding alone is none. Within a body a pair is none either where the mesh leads from one to the other
/// on a way that is hardly longer than the thickness: thick shells are near their own neighbours.
[[nodiscard]] InitialPenetrations find_initial_penetrations(const model::Model& model, std::span<const Vec3d> position);

/// Gathers them by described bodies, in the order of these.
[[nodiscard]] std::vector<PenetratingBodies> by_bodies(const model::Model& model, const InitialPenetrations& found);

}  // namespace fexp::contact
