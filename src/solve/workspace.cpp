// SPDX-License-Identifier: Apache-2.0
#include "solve/workspace.hpp"

#include <algorithm>

namespace fexp::solve {

Workspace::Workspace(const model::Model& model, SelectedKernel selected_kernel)
    : kernel(selected_kernel), patches(model) {
  for (const model::SectionData& section : model.sections) {
    sections.emplace_back(physics::ShellSection{section.thickness, section.moduli, model.run.drilling});
  }
  border_force.resize(at(patches.border_start.back()));
  inverse_inertia.reserve(model.mass.size());
  for (std::size_t n = 0; n < model.mass.size(); ++n) {
    const auto node = static_cast<Index>(n);
    inverse_inertia.push_back({1.0 / model.moving_mass(node), 1.0 / model.moving_inertia(node)});
  }
  for (const model::Tie& tie : model.ties.ties) {
    if (!tie.is_fixed()) {
      carry(tie);
    }
  }
  contact.force.resize(model.reference_position.size());
  contact.stiffness.resize(model.reference_position.size());
  if (!model.gravity.empty() || !model.pressure.empty() || !model.forces.empty()) {
    load.resize(model.reference_position.size());
  }
  actions.resize(model.bodies.size());
  for (BodyActions& body : actions) {
    body.wall_force.resize(model.walls.size());
  }
  body_contact.resize(model.bodies.size());
  const bool holds_rigid =
      std::any_of(model.rigid_bodies.begin(), model.rigid_bodies.end(), [](const model::RigidBody& body) {
        return !body.turns_freely || !body.held.empty() || !body.prescribed.empty();
      });
  external = holds_rigid || !load.empty() || model.run.damping > 0.0 || model.run.is_static() || !model.walls.empty() ||
             !model.fixed.empty() || !model.prescribed.empty() || !model.symmetry.empty() || !model.oblique.empty() ||
             !model.ties.empty();
}

void Workspace::carry(const model::Tie& tie) noexcept {
  InverseInertia& inverse = inverse_inertia[at(tie.node)];
  inverse = {1.0, tie.rotations ? 1.0 : inverse.inertia};
}

}  // namespace fexp::solve
