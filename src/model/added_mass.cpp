// SPDX-License-Identifier: Apache-2.0
#include "model/added_mass.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace fexp::model {

std::vector<AddedMass> added_masses(const Model& model) {
  std::map<std::pair<Index, Index>, AddedMass> parts;  // By described body and part
  for (Index e = 0; e < static_cast<Index>(model.step_factor.size()); ++e) {
    const Body& body = model.bodies[at(model.blocks[at(model.element_block[at(e)])].body)];
    AddedMass& part = parts[{body.description, model.element_part[at(e)]}];
    const SectionData& section = model.section_of(e);
    const double mass = section.density * section.thickness * model.reference_area[at(e)];
    const double factor = model.mass_factor(e);
    part.body = body.family;
    part.mass += mass;
    part.added += (factor - 1.0) * mass;
    part.elements += factor > 1.0 ? 1 : 0;
    part.largest = std::max(part.largest, factor);
  }
  std::vector<AddedMass> found;
  for (auto& [key, part] : parts) {
    if (part.elements > 0) {
      part.part = model.part_names[at(key.first)][at(key.second)];
      found.push_back(std::move(part));
    }
  }
  return found;
}

}  // namespace fexp::model
