// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "cluster/simulation.hpp"

namespace fexp::cluster {

namespace {

Index body_of_element(const model::Model& model, Index element) {
  return model.blocks[at(model.element_block[at(element)])].body;
}

}  // namespace

Fault Simulation::not_finite_fault(const RankRecord& record) const {
  Fault fault;
  fault.kind = FaultKind::not_finite;
  fault.node = record.broken_node;
  fault.body = model_.node_body[at(fault.node)];
  fault.element = model_.corner[at(model_.corner_start[at(fault.node)])] / 3;
  fault.message = fmt::format("step {}: the velocity of node {} of body \"{}\" (element {}) is not a finite number",
                              state_.step + record.broken_steps + 1, model_.node_label[at(fault.node)],
                              model_.bodies[at(fault.body)].name, model_.element_label[at(fault.element)]);
  fault.cure = "check density, thickness, loads and penalty_scale there, or lower run.safety";
  return fault;
}

Fault Simulation::collapsed_fault() const {
  Fault fault;
  fault.kind = FaultKind::step_collapsed;
  fault.element = critical_.element;
  fault.body = body_of_element(model_, fault.element);
  fault.message =
      fmt::format("the critical step fell to {:.3g}, which is {:.2g} of the first one, at element {} of body \"{}\"",
                  critical_.step, critical_.step / model_.first_critical_step, model_.element_label[at(fault.element)],
                  model_.bodies[at(fault.body)].name);
  fault.cure = "the element is crushed or torn: refine the mesh there, lower the load, or lower penalty_scale";
  return fault;
}

Fault Simulation::energy_fault(const EpochReport& report) {
  // Rank 0, which speaks for all, is to find the most strained element of the whole model.
  collect();
  Fault fault;
  fault.kind = FaultKind::energy_drift;
  std::string where;
  if (report.deepest_element != no_index && report.deepest > 0.5) {
    fault.element = report.deepest_element;
    fault.node = report.deepest_node;
    where = fmt::format("deepest contact: node {} of body \"{}\" in", model_.node_label[at(fault.node)],
                        model_.bodies[at(model_.node_body[at(fault.node)])].name);
    fault.cure = "raise contact.penalty_scale or lower run.safety";
  } else {
    double densest = -1.0;
    for (Index e = 0; e < model_.element_count(); ++e) {
      const double density =
          std::abs(element_value(model_, state_, e, model::row_energy)) / model_.reference_area[at(e)];
      if (density > densest) {
        densest = density;
        fault.element = e;
      }
    }
    where = "most strained:";
    fault.cure =
        "lower run.safety, refine the mesh there, or raise run.energy_drift_limit if the imbalance is expected";
  }
  fault.body = body_of_element(model_, fault.element);
  fault.message =
      fmt::format("step {}: the energy balance is off by {:.3g} (bound {:.3g}); {} element {} of body \"{}\"",
                  state_.step, report.energy_error, model_.run.energy_drift_limit, where,
                  model_.element_label[at(fault.element)], model_.bodies[at(fault.body)].name);
  return fault;
}

}  // namespace fexp::cluster
