// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::contact {

/// Sums of contact over one body at one instant.
struct BodyContact {
  double energy{};       ///< Potential of the pairs booked to the body [force*length]
  Vec3d barrier_force;   ///< Force of barriers on the body [force]
  Vec3d barrier_moment;  ///< The same about the origin [force*length]
};

struct ContactReport {
  Index active_pairs{};               ///< Pairs with a force
  Index candidates{};                 ///< Pairs watched
  Index searches{};                   ///< Since the island was taken up
  double deepest{};                   ///< Deepest penetration over contact distance [-]
  Index deepest_node{no_index};
  Index deepest_element{no_index};
  double max_stiffness_over_mass{};   ///< Bound of contact's share of omega^2 [1/time^2]
};

/// Contact inside one island.
class IslandContact {
 public:
  void assign(const model::Model& model, std::span<const Index> bodies, std::span<const Index> barriers,
              const model::State& state);
  void advance(const model::Model& model, const model::NodeMotion* motion, double largest_way);
  ContactReport evaluate(const model::Model& model, const model::NodeMotion* motion, double dt, Vec3d* force,
                         BodyContact* bodies);
  void store_sides(const model::Model& model, model::State& state) const;
};

}  // namespace fexp::contact
