// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/candidate_rows.hpp"
#include "contact/surface.hpp"
#include "physics/penalty.hpp"

namespace fexp::contact {

/// A pair that pushes: the force on the node; the element's corners get it back by their weights.
struct ActivePair {
  Index node{};
  Index element{};
  std::array<double, 3> weight{};
  Vec3d force;          ///< On the node [force]
  double energy{};      ///< Of the penalty, and of sticking [force*length]
  double dissipated{};  ///< In this step, by friction and damping [force*length]
  double stiffness{};   ///< Slope of the penalty [force/length], more by damping; 0 where a pair has parted and only
                        ///< leaves its energy
  double depth{};       ///< Penetration over contact distance [-]
};

/// Watches one node at a time against the triangles near it: remembers on which side of each it stands, decides which
/// of the triangles that share the closest feature acts, and gives the penalty forces.
///
/// Gap of node i and element T [W06; REK19 eq. 6-7, whose eq. 6 prints p_N g_N <= 0 where complementarity needs = 0]:
/// g = side * s - d, with the signed distance s to the closest point of T, the remembered side (+1 or -1), and the
/// contact distance d, the half thickness of the node plus that of the surface at the closest point. A penalty of the
/// depth -g where g < 0 (physics::penalty_of), along the offset from the closest point, away from it on the remembered
/// side: a node that has come through is pushed back the way it came. Pairs that are closer than d in the reference
/// configuration take that distance for d, so that nothing pushes in a mesh as it was built.
class NodeWatch {
 public:
  /// Where `before` is `now`, nothing has moved since the sides were remembered. They are then taken as they are, so
  /// that a state gives the same forces and sides however often it is looked at.
  NodeWatch(const model::Model& model, Positions now, Positions before)
      : model_(model),
        now_(now),
        before_(before),
        laws_(model.contact_laws),
        normals_(model, now),
        normals_before_(model, before),
        still_(before.back == now.back) {}

  /// Looks at `node`, which has `candidates` and `memory` (sides of this node's pairs at the last step; both ascending
  /// in element). Appends what is remembered now to `remembered` and pairs with a force to `active`.
  void look(Index node, CandidateRow candidates, std::span<const model::ContactSide> memory,
            std::vector<model::ContactSide>& remembered, std::vector<ActivePair>& active);

 private:
  struct Watched {
    Index element{};
    physics::ClosestPoint closest{};
    Vec3d normal;            ///< Unit normal of the element
    double distance{};       ///< To the closest point [length]
    View view;               ///< Where the node stands now
    int side{};              ///< Where it belongs; 0 while not decided
    bool rim{};              ///< The closest point lies on the rim of an open surface
    bool acts{};             ///< No element that shares the feature is closer
    Index closer{no_index};  ///< The closest of those, when it does not act
    double full{};           ///< Contact distance by the thicknesses alone, where it acts [length]
    double reach{};          ///< Contact distance, where it acts [length]
    double depth{};          ///< Of the node, where it acts [length]
    Vec3d drag;              ///< Friction and damping on the node [force]

    /// Whether a node that belongs on `home` has come through here. Off the rim of an open surface and off the tip of a
    /// sharp fold there is no other side to come from.
    [[nodiscard]] bool is_through(int home) const noexcept { return !rim && view.agreed && view.side != home; }
    [[nodiscard]] bool is_nearer(const Watched& other) const noexcept {
      return closest.distance2 < other.closest.distance2 ||
             (closest.distance2 == other.closest.distance2 && element < other.element);
    }
  };

  /// An element to be measured, and which of the candidates it is, if it is one.
  struct Near {
    Index element{};
    Index candidate{no_index};
  };

  void recall(std::span<const model::ContactSide> memory);
  void gather(const CandidateRow& candidates, std::span<const model::ContactSide> memory);
  void follow(const model::ContactSide& known);
  void measure(CandidateRow& candidates);
  void decide_sides(std::span<const model::ContactSide> memory);
  void find_depths();
  void leave_one_of_smooth_neighbours();
  void push(std::span<const model::ContactSide> memory, std::vector<ActivePair>& active);
  void drag(Watched& watched, const physics::DragLaw& law, double stiffness, std::span<const model::ContactSide> memory,
            ActivePair& pair);
  [[nodiscard]] const model::ContactSide* drag_before(Index element, std::span<const model::ContactSide> memory) const;
  void part(std::span<const model::ContactSide> memory, std::vector<ActivePair>& active);
  [[nodiscard]] Vec3d way_of(const Watched& watched) const;

  [[nodiscard]] double depth_limit(Index element) const;
  [[nodiscard]] Watched measured(Index element);
  [[nodiscard]] bool could_come_through(const Watched& watched, int home);
  [[nodiscard]] int inherited_side(Index element) const;
  [[nodiscard]] double full_distance(const Watched& watched) const;
  [[nodiscard]] double contact_distance(const Watched& watched, double full) const;
  [[nodiscard]] const model::ContactLaw& law_of(const Watched& watched) const;
  [[nodiscard]] double stiffness(const Watched& watched, const model::ContactLaw& law) const;
  [[nodiscard]] bool hides(const Watched& other, const Watched& watched) const;
  [[nodiscard]] static Vec3d direction(const Watched& watched);
  [[nodiscard]] bool are_neighbours(const Watched& a, const Watched& b) const;
  [[nodiscard]] bool is_joined_with(Index element) const;
  [[nodiscard]] bool share_corner(Index a, Index b) const;

  const model::Model& model_;
  Positions now_;
  Positions before_;
  const model::ContactLaws& laws_;
  Normals normals_;
  Normals normals_before_;
  bool still_{};
  Index node_{};
  Vec3d point_;
  std::vector<Near> near_;
  std::vector<model::ContactSide> deep_;     ///< Elements that the node has come through and where it belongs
  std::vector<model::ContactSide> through_;  ///< Of those remembered, the ones that the node has come through
  std::vector<Watched> followed_;            ///< Those remembered, as they are measured now
  std::vector<Watched> watched_;
  std::vector<char> handed_on_;  ///< Of the pairs remembered, those whose drag goes on
};

}  // namespace fexp::contact
