// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/aligned_vector.hpp"
#include "contact/island_contact.hpp"
#include "model/model.hpp"
#include "physics/c0_triangle.hpp"
#include "solve/kernels.hpp"
#include "solve/patches.hpp"

namespace fexp::solve {

/// Force and moment on a node.
struct NodalAction {
  Vec3d force;   ///< [force]
  Vec3d moment;  ///< [force*length]
};

/// Sums of external actions over one body at one instant.
struct BodyActions {
  Vec3d force;                    ///< [force]
  Vec3d moment;                   ///< About the origin [force*length]
  std::vector<Vec3d> wall_force;  ///< Force of each rigid wall on the body [force], shape [walls]
};

/// Arrays that every step overwrites; one for the whole model, each island writes only its own bodies' parts.
struct Workspace {
  explicit Workspace(const model::Model& model, SelectedKernel selected_kernel);

  /// Has the acceleration of a tied node be its force, whose inertia must be its own where it turns freely.
  void carry(const model::Tie& tie) noexcept;

  SelectedKernel kernel;
  std::vector<physics::ShellStiffness> sections;  // [sections]
  Patches patches;
  AlignedVector<NodeForce> border_force;  // [shares of border nodes]
  /// Shape [nodes]; 1 for what ties carry of a node, so that its acceleration is the force, until that is handed on.
  AlignedVector<InverseInertia> inverse_inertia;
  contact::NodeContact contact;  // At the last evaluated positions
  /// Loads and gravity at the last evaluated instant, shape [nodes]; empty when the model has none.
  std::vector<NodalAction> load;
  std::vector<BodyActions> actions;                // [bodies]
  std::vector<contact::BodyContact> body_contact;  // [bodies]
  bool external{};  ///< Anything at all acts on the model from outside (loads, walls, damping, conditions), or ties.
};

}  // namespace fexp::solve
