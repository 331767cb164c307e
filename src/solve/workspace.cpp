// SPDX-License-Identifier: Apache-2.0
#include "solve/workspace.hpp"

namespace fexp::solve {

Workspace::Workspace(const model::Model& model, SelectedKernel selected_kernel) : kernel(selected_kernel) {
  for (const model::SectionData& section : model.sections) {
    sections.push_back({section.thickness, section.moduli, model.run.drilling});
  }
  corner_force.resize(3 * model.triangle.size());
  contact.force.resize(model.reference_position.size());
  contact.stiffness.resize(model.reference_position.size());
  if (!model.gravity.empty() || !model.pressure.empty() || !model.forces.empty()) {
    load.resize(model.reference_position.size());
  }
  actions.resize(model.bodies.size());
  for (BodyActions& body : actions) {
    body.plane_force.resize(model.planes.size());
  }
  body_contact.resize(model.bodies.size());
  external = !load.empty() || model.run.damping > 0.0 || !model.planes.empty() || !model.fixed.empty() ||
             !model.prescribed.empty() || !model.symmetry.empty();
}

}  // namespace fexp::solve
