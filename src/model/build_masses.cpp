// SPDX-License-Identifier: Apache-2.0
#include "model/build_masses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/build_checks.hpp"
#include "model/build_ties.hpp"
#include "model/element_shares.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

/// What elements at ties get besides for the mass that others get.
constexpr double room_for_mass = 1.001;

/// Gives the elements of rigid bodies whose mass is given the density for it, and takes all of them out of the search
/// for the smallest step, unless there are no others: then they stand for what the penalty stiffness of contact has to
/// go by.
void make_rigid(const Description& description, Model& model, ElementShares& shares) {
  const auto is_rigid = [&](const Body& body) { return description.bodies[at(body.description)].rigid; };
  const bool all_rigid = std::all_of(model.bodies.begin(), model.bodies.end(), is_rigid);
  for (Body& body : model.bodies) {
    if (!is_rigid(body)) {
      continue;
    }
    const double given = description.bodies[at(body.description)].mass;
    double sum = 0.0;
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      sum += 3.0 * shares.mass[at(e)];
    }
    body.density_factor = given > 0.0 ? given / sum : 1.0;
    for (Index e = body.elements.begin; e < body.elements.end; ++e) {
      shares.mass[at(e)] *= body.density_factor;
      shares.inertia[at(e)] *= body.density_factor;
      shares.step[at(e)] = all_rigid ? std::sqrt(body.density_factor) * shares.step[at(e)] : HUGE_VAL;
    }
  }
}

/// The undamped step that run.minimum_step asks for [time].
double least_step(const RunSettings& run) {
  const double damped = run.minimum_step / run.safety;
  return std::sqrt(damped * damped + 2.0 * run.stiffness_damping * damped);
}

/// Gives elements that need a smaller step than asked for as much mass as it takes: the step goes with its root. With
/// stiffness damping beta a step dt is critical for the undamped one sqrt(dt^2 + 2 beta dt).
void scale_masses(Model& model, std::span<const double> ratio, ElementShares& shares) {
  if (model.run.minimum_step < 0.0) {
    return;
  }
  std::vector<double> factors(shares.step.size(), 1.0);
  bool any = false;
  for (std::size_t e = 0; e < shares.step.size(); ++e) {
    const double target = least_step(model.run) * (ratio.empty() ? 1.0 : std::sqrt(ratio[at(model.element_block[e])]));
    if (shares.step[e] < target) {
      const double factor = target / shares.step[e];
      any = true;
      factors[e] = factor;
      shares.mass[e] *= factor * factor;
      shares.inertia[e] *= factor * factor;
      shares.step[e] *= factor;
    }
  }
  if (any) {
    model.step_factor = std::move(factors);
  }
}

}  // namespace

void build_masses(const Description& description, Model& model, std::span<const double> ratio) {
  const std::size_t elements = model.triangle.size(), nodes = model.reference_position.size();
  ElementShares shares = element_shares(model);
  model.reference_area = std::move(shares.area);
  make_rigid(description, model, shares);
  scale_masses(model, ratio, shares);
  model.first_critical_step = HUGE_VAL;
  for (std::size_t e = 0; e < elements; ++e) {
    if (shares.step[e] < model.first_critical_step) {
      model.first_critical_step = shares.step[e];
      model.first_critical_element = static_cast<Index>(e);
    }
  }
  model.mass.resize(nodes);
  model.inertia.resize(nodes);
  model.half_thickness.resize(nodes);
  model.node_size.resize(nodes);
  parallel::for_each(model.node_count(), 1024, [&](Index n) {
    double mass = 0.0, inertia = 0.0, thickness = 0.0, area = HUGE_VAL;
    for (Index c = model.corner_start[at(n)]; c < model.corner_start[at(n) + 1]; ++c) {
      const Index e = model.corner[at(c)] / 3;
      mass += shares.mass[at(e)];
      inertia += shares.inertia[at(e)];
      thickness = std::max(thickness, model.section_of(e).thickness);
      area = std::min(area, model.reference_area[at(e)]);
    }
    model.mass[at(n)] = mass;
    model.inertia[at(n)] = inertia;
    model.half_thickness[at(n)] = 0.5 * thickness;
    model.node_size[at(n)] = std::sqrt(area);
  });
  for (const AddedNode& point : model.point_masses) {
    model.mass[at(point.node)] += point.mass;
    model.inertia[at(point.node)] += point.inertia;
  }
  for (Body& body : model.bodies) {
    for (Index n = body.nodes.begin; n < body.nodes.end; ++n) {
      body.mass += model.mass[at(n)];
    }
  }
}

bool raise_ratios(const Model& model, bool to_the_bound, std::vector<double>& ratio) {
  if (model.run.minimum_step < 0.0 || model.ties.blocks.empty()) {
    return false;
  }
  std::vector<double> step(model.blocks.size(), HUGE_VAL);
  const ElementShares shares = element_shares(model);
  for (std::size_t e = 0; e < shares.step.size(); ++e) {
    const double factor = model.step_factor.empty() ? 1.0 : model.step_factor[e];
    double& smallest = step[at(model.element_block[e])];
    smallest = std::min(smallest, factor * shares.step[e]);
  }
  bool raised = false;
  ratio.resize(model.blocks.size(), 1.0);
  for (const TiedBlock& tied : model.ties.blocks) {
    double& known = ratio[at(tied.block)];
    if (tied.ratio > known && step[at(tied.block)] < std::sqrt(tied.ratio) * least_step(model.run)) {
      known = to_the_bound ? largest_tie_ratio : std::min(room_for_mass * tied.ratio, largest_tie_ratio);
      raised = true;
    }
  }
  return raised;
}

void check_masses(const Description& description, const Model& model, ErrorList& errors) {
  Index reported = no_index;
  for (const Body& body : model.bodies) {
    for (Index n = body.nodes.begin; n < body.nodes.end && body.description != reported; ++n) {
      if (positive.contains(model.mass[at(n)]) && positive.contains(model.inertia[at(n)]) &&
          positive.contains(model.contact_stiffness[at(n)])) {
        continue;
      }
      const bool alone = model.corner_start[at(n)] == model.corner_start[at(n) + 1];
      errors.add(description.bodies[at(body.description)].place,
                 fmt::format("node {} of body \"{}\" {}", model.node_label[at(n)], body.name,
                             alone ? "belongs to no triangle"
                                   : fmt::format("has mass {:g} and penalty stiffness {:g}", model.mass[at(n)],
                                                 model.contact_stiffness[at(n)])),
                 "positive finite mass and stiffness at every node",
                 alone ? "remove the node from the mesh" : "correct scale, thickness, material or their units");
      reported = body.description;
    }
  }
}

}  // namespace fexp::model
