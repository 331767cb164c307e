// SPDX-License-Identifier: Apache-2.0
#include "model/added_mass.hpp"

#include <fmt/format.h>

#include <utility>

#include "quality/assess.hpp"
#include "quality/first_copies.hpp"

namespace fexp::quality {

std::vector<Finding> added_mass(const model::Model& model) {
  std::vector<Finding> findings;
  for (const model::AddedMass& part : model::added_masses(model)) {
    const double share = part.added / part.mass;
    const bool much = share > model::much_added_mass;
    Finding finding;
    finding.kind = "added_mass";
    finding.severity = much ? Severity::warning : Severity::note;
    finding.body = part.body;
    finding.item = "element";
    finding.count = part.elements;
    finding.numbers = {{"mass", part.mass}, {"added", part.added}, {"largest_factor", part.largest}};
    finding.message = fmt::format(
        "mass scaling adds {:.4g} to the {:.4g} of part \"{}\", {:.2g} %, in {} elements, of which the heaviest has "
        "{:.3g} "
        "times its mass",
        part.added, part.mass, part.part, 100.0 * share, part.elements, part.largest);
    finding.cure =
        much ? "inertia forces are off by as much; lower run.minimum_step, or remesh the small elements" : "";
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace fexp::quality
