// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "contact/candidate_rows.hpp"
#include "contact/surface.hpp"
#include "model/branches.hpp"
#include "physics/closest_lines.hpp"
#include "physics/crossing_edges.hpp"
#include "physics/penalty.hpp"

namespace fexp::contact {

/// A pair of edges that pushes, and what it does to the nodes. The forces sum to zero.
struct ActiveEdges {
  Index first{};
  Index second{};
  std::array<Vec3d, 4> force;                       ///< On the ends of the first and of the second edge [force]
  std::array<Index, 2> corner{no_index, no_index};  ///< Nodes besides, those of triangles at one of the edges
  std::array<Vec3d, 2> corner_force;                ///< [force]
  std::array<double, 2> corner_stiffness{};         ///< A bound [force/length]
  double at_first{};                                ///< Where along the edge, 0 to 1
  double at_second{};
  double energy{};  ///< As of ActivePair, and so on
  double dissipated{};
  double stiffness{};  ///< A bound where the pair fades; more by damping
  double depth{};
};

/// Watches pairs of edges that cross each other, seen along their common normal: which side of the first edge the
/// second one belongs on, and the penalty force while they are closer than contact distance.
///
/// The gap is that of nodes and elements: side x distance - d, with the sum d of both half thicknesses where the edges
/// are closest, or the distance in the reference configuration where that is less. Edges push where the surfaces are
/// closest at their crossing, see physics::sharpness_of; elsewhere nodes against elements see what is closest. Where an
/// end of one edge is as close to the other edge, it pushes as a node. So a pair has the potential
///
///     s (U(g) - max U_i(g_i))
///
/// with the sharpness s, the penalty's energy U, the edges' gap g and those of the four ends g_i: it passes into that
/// of a node where the crossing slides over an end, and is there only once. All forces are its derivatives (but those
/// of k and d).
class EdgeWatch {
 public:
  /// Where `before` is `now`, as for NodeWatch.
  EdgeWatch(const model::Model& model, Positions now, Positions before)
      : model_(model), now_(now), before_(before), still_(before.back == now.back) {}

  /// Looks at an edge, which has candidates and a memory (both ascending). Appends what is remembered now and the pairs
  /// with a force.
  void look(Index first, CandidateRow candidates, std::span<const model::EdgeSide> memory,
            std::vector<model::EdgeSide>& remembered, std::vector<ActiveEdges>& active) const;

 private:
  /// Where two edges are closest, or an end and an edge.
  struct Place {
    double first{};  ///< Along the first edge, 0 to 1
    double second{};
    double full{};        ///< Half thicknesses together [length]
    double distance{};    ///< Of contact [length]
    double compliance{};  ///< Of the ends by their weights, in series [length/force]
    double inverse_mass{};
  };
  /// And its derivatives by the height and by the nearness, less the distance.
  struct Depth {
    double value{};  ///< [length]
    double by_height{};
    double by_nearness{};
  };
  struct Pair {
    Index first{};
    Index second{};
    std::array<Index, 4> node{};  ///< Ends of the first and of the second edge
    double thickest{};            ///< Largest half thicknesses of both [length]
    double reach{};               ///< Watch distance [length]
    physics::ClosestOnLines lines;
    bool inside{};  ///< The edges cross within both, at an angle
    [[nodiscard]] bool is_near() const noexcept { return inside && std::abs(lines.gap) < reach; }
    [[nodiscard]] int side() const noexcept { return lines.gap < 0.0 ? -1 : 1; }
  };

  using Corners = std::array<Index, 2 * physics::most_at_edge>;

  [[nodiscard]] Pair pair_at(const Positions& x, Index first, Index second) const;
  [[nodiscard]] bool is_there(Index edge) const;
  [[nodiscard]] Vec3d way_of(const Pair& pair) const;
  [[nodiscard]] int side_of(const Pair& pair, const model::EdgeSide* known) const;
  [[nodiscard]] physics::Sharpness sharpness_of(const Pair& pair, int side, Corners& corner) const;
  [[nodiscard]] double most_distance(const Pair& pair) const;
  [[nodiscard]] Place place_at(const Pair& pair, double first, double second, double most_distance) const;
  [[nodiscard]] bool have_joined_ends(const Pair& pair) const;
  [[nodiscard]] double motion_before(const Pair& pair) const;
  [[nodiscard]] const model::ContactLaw& law_of(const Pair& pair) const;
  [[nodiscard]] static Depth depth_at(double contact_distance, double distance, double height, double reach);
  void watch(const Pair& pair, const model::EdgeSide* known, std::vector<model::EdgeSide>& remembered,
             std::vector<ActiveEdges>& active) const;
  void part(Pair pair, const Vec3d& drag_before, std::vector<ActiveEdges>& active) const;
  void push(model::EdgeSide& known, const Pair& pair, const Vec3d& drag_before, std::vector<ActiveEdges>& active) const;
  void leave_to_ends(const Pair& pair, const model::ContactLaw& law, double most_distance, double height,
                     const Vec3d& normal, ActiveEdges& push) const;
  void drag(model::EdgeSide& known, const Pair& pair, const physics::DragLaw& law, const Place& place,
            const Vec3d& normal, double stiffness, const Vec3d& drag_before, ActiveEdges& push) const;

  const model::Model& model_;
  Positions now_;
  Positions before_;
  bool still_{};
};

/// Larger half thickness of an edge's ends [length].
[[nodiscard]] inline double edge_half_thickness(const model::Model& model, std::array<Index, 2> ends) noexcept {
  const double a = model.half_thickness[at(ends[0])], b = model.half_thickness[at(ends[1])];
  return a > b ? a : b;
}

/// Half of what an edge may travel in a step [length].
[[nodiscard]] inline double edge_margin(const model::Model& model, std::array<Index, 2> ends) noexcept {
  const double p = model.node_size[at(ends[0])], q = model.node_size[at(ends[1])];
  return 0.5 * model::watch_margin(p < q ? p : q);
}

/// Part of a pair's watch distance that an edge brings [length].
[[nodiscard]] inline double edge_reach(const model::Model& model, Index edge) noexcept {
  const std::array<Index, 2> ends = ends_of(model, edge);
  return edge_half_thickness(model, ends) + edge_margin(model, ends);
}

}  // namespace fexp::contact
