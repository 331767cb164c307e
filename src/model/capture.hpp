// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"
#include "model/state.hpp"

namespace fexp::model {

/// What results hold of one moment: a copy, so that output never looks at the state while it is being stepped.
/// Positions keep all their bits, because they are what two runs are compared by; everything else is looked at, and
/// single precision halves the file.
struct Frame {
  std::int64_t step{};
  double time{};  ///< [time]

  // Nodes, shape [nodes]
  std::vector<Vec3d> position;                      ///< x [length]
  std::vector<std::array<float, 3>> displacement;   ///< x - X [length]
  std::vector<std::array<float, 3>> velocity;       ///< [length/time]
  std::vector<std::array<float, 3>> rotation_rate;  ///< [1/time]
  std::vector<std::array<float, 3>> contact_force;  ///< From other shells and itself, without rigid walls [force]
  std::vector<std::array<float, 3>> tie_force;      ///< Of tied nodes on what carries them [force]
  std::vector<Index> tied;                          ///< 1 while a tie holds the node, else 0

  // Elements, shape [elements]; resultants in the element frame: x along the edge from corner 1 to 2, z the normal
  std::vector<std::array<float, 3>> membrane_force;  ///< nxx nyy nxy [force/length]
  std::vector<std::array<float, 3>> bending_moment;  ///< mxx myy mxy [force]
  std::vector<std::array<float, 2>> shear_force;     ///< qxz qyz [force/length]
  /// On the side the normal points to; at the outermost point where the section has points [force/length^2]
  std::vector<float> von_mises_top;
  std::vector<float> von_mises_bottom;  ///< On the other side [force/length^2]
  std::vector<float> energy_density;    ///< Internal energy over reference volume [force/length^2]
  std::vector<float> thickness;         ///< [length]
  std::vector<float> plastic_strain;    ///< Effective, largest of the element's points [-]
  std::vector<float> temperature;       ///< Highest of the element's points, 0 where they do not heat [temperature]
  std::vector<Index> deleted;           ///< 1 when the element has failed, else 0
  std::vector<Index> body;
  std::vector<Index> island;  ///< no_index for a barrier
};

/// Copies the present state into `frame`, whose buffers are used again. `contact_force` has shape [nodes] [force];
/// `island_of_body` has shape [bodies]. Either may be empty: then forces are zero and islands no_index.
void capture_into(const Model& model, const State& state, std::span<const Vec3d> contact_force,
                  std::span<const Index> island_of_body, Frame& frame);

[[nodiscard]] Frame capture(const Model& model, const State& state, std::span<const Vec3d> contact_force,
                            std::span<const Index> island_of_body);

}  // namespace fexp::model
