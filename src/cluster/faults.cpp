// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cluster/simulation.hpp"
#include "contact/surface.hpp"

/// What a fault is called, where it is, and what usually cures it.
namespace fexp::cluster {

namespace {

/// A fault that came within one epoch may be one of the step: a balance that was off by less than this part of its
/// bound before, a critical step that was more than twice what counts as collapsed.
constexpr double sudden = 0.5;

/// Node and element of two bodies that are in contact there, and how hard.
struct Touch {
  Index node{no_index};
  Index element{no_index};
  double force{-1.0};  ///< The largest on a node of the pair [force]
};

std::string name_of(const model::Model& model, Index body) {
  return fmt::format("body \"{}\"", model.bodies[at(body)].name);
}
std::string node_text(const model::Model& model, Index node) {
  return fmt::format("node {} of {}", model.node_label[at(node)], name_of(model, model.node_body[at(node)]));
}
std::string element_text(const model::Model& model, Index element) {
  return fmt::format("element {} of {}", model.element_label[at(element)],
                     name_of(model, contact::body_of_element(model, element)));
}
std::string pair_text(const model::Model& model, Index body, Index other) {
  return body == other ? fmt::format("{} with itself", name_of(model, body))
                       : fmt::format("{} with {}", name_of(model, body), name_of(model, other));
}

std::string wall_text(const model::Model& model, Index wall) {
  return fmt::format("rigid wall \"{}\"", model.walls[at(wall)].name);
}

/// The rigid walls that push a body, or a text without any.
std::string walls_text(const model::Model& model, const solve::BodyActions& actions) {
  std::string text;
  for (std::size_t w = 0; w < actions.wall_force.size(); ++w) {
    if (actions.wall_force[w] != Vec3d{}) {
      text += (text.empty() ? "" : ", ") + wall_text(model, static_cast<Index>(w));
    }
  }
  return text;
}

/// An element at the node; no_index for that of a rigid wall with mass.
Index element_at(const model::Model& model, Index node) {
  const Index first = model.corner_start[at(node)];
  return first < model.corner_start[at(node) + 1] ? model.corner[at(first)] / 3 : no_index;
}

/// Calls visit(node, element) for what `body` remembers of contact.
template <class Visit>
void for_each_side(const model::Model& model, const model::State& state, Index body, const Visit& visit) {
  for (const model::ContactSide& side : state.sides[at(body)]) {
    visit(side.node, side.element);
  }
  for (const model::EdgeSide& side : state.edge_sides[at(body)]) {
    for (const Index node : contact::ends_of(model, side.first)) {
      visit(node, side.second / 3);
    }
  }
}

/// Where two bodies push each other hardest, among what they remember of each other.
Touch hardest_touch(const model::Model& model, const model::State& state, const std::vector<Vec3d>& force, Index body,
                    Index other) {
  Touch hardest;
  const auto visit = [&](Index node, Index element) {
    const Index a = model.node_body[at(node)], b = contact::body_of_element(model, element);
    if (std::minmax(a, b) != std::minmax(body, other)) {
      return;
    }
    double largest = norm(force[at(node)]);
    for (const Index corner : model.triangle[at(element)]) {
      largest = std::max(largest, norm(force[at(corner)]));
    }
    if (largest > hardest.force) {
      hardest = {node, element, largest};
    }
  };
  for_each_side(model, state, body, visit);
  if (other != body) {
    for_each_side(model, state, other, visit);
  }
  return hardest;
}

/// The element of a body with the most energy on its area.
Index most_strained(const model::Model& model, const model::State& state, Index body) {
  const IndexRange elements = model.bodies[at(body)].elements;
  Index strained = elements.begin;
  double densest = -1.0;
  for (Index e = elements.begin; e < elements.end; ++e) {
    const double density = std::abs(element_value(model, state, e, model::row_energy)) / model.reference_area[at(e)];
    if (density > densest) {
      densest = density;
      strained = e;
    }
  }
  return strained;
}

}  // namespace

/// Whether no epoch that led here has been done with half the step.
bool Simulation::may_halve() const { return backup_.time > half_until_; }

/// Whether half the step may help: where what is wrong came up within this epoch.
bool Simulation::is_curable(const EpochReport& report) const {
  if (!may_halve()) {
    return false;
  }
  switch (report.fault.kind) {
    case FaultKind::not_finite:
      return true;
    case FaultKind::energy_drift:
      return extremes_.energy_error <= sudden * model_.run.energy_drift_limit;
    case FaultKind::step_collapsed:
      return step_before_ > model_.run.step_collapse * model_.first_critical_step / sudden;
    default:
      return false;
  }
}

/// Puts a fault into words, with rank 0 speaking for all.
void Simulation::describe(EpochReport& report) {
  // It is to look at the whole model.
  collect();
  switch (report.fault.kind) {
    case FaultKind::not_finite:
      describe_break(report.fault);
      break;
    case FaultKind::step_collapsed:
    case FaultKind::step_not_found:
      describe_collapse(report, report.fault);
      break;
    default:
      describe_drift(report, report.fault);
      break;
  }
  add_history(report.fault);
}

void Simulation::describe_break(Fault& fault) const {
  fault.body = model_.node_body[at(fault.node)];
  fault.element = element_at(model_, fault.node);
  if (fault.element == no_index) {
    fault.message = fmt::format("step {}: the velocity of {} is not a finite number", fault.step,
                                wall_text(model_, model_.bodies[at(fault.body)].wall));
    fault.cure = "check its mass, force and initial_velocity and what it touches, or lower run.safety";
    return;
  }
  const std::string walls = walls_text(model_, workspace_.actions[at(fault.body)]);
  std::string contact;
  double hardest = 0.0;
  const auto visit = [&](Index node, Index element) {
    const auto& corners = model_.triangle[at(element)];
    const bool is_met = node == fault.node || std::ranges::find(corners, fault.node) != corners.end();
    const double force = norm(workspace_.contact.force[at(node)]);
    if (is_met && force > hardest) {
      const Index a = model_.node_body[at(node)], b = contact::body_of_element(model_, element);
      hardest = force;
      fault.other = a == fault.body ? b : a;
      contact =
          fmt::format(", which was in contact: {} with {}", node_text(model_, node), element_text(model_, element));
    }
  };
  for (Index body = 0; body < model_.body_count(); ++body) {
    for_each_side(model_, state_, body, visit);
  }
  fault.message =
      fmt::format("step {}: the velocity of node {} of body \"{}\" (element {}) is not a finite number{}{}", fault.step,
                  model_.node_label[at(fault.node)], model_.bodies[at(fault.body)].name,
                  model_.element_label[at(fault.element)], contact, walls.empty() ? "" : "; the body is on " + walls);
  fault.cure = contact.empty() ? "check density, thickness, loads and initial velocities there, or lower run.safety"
                               : "lower contact.stiffness or contact.penalty_scale, check density and thickness "
                                 "there and whether the bodies overlap at the start, or lower run.safety";
}

void Simulation::describe_collapse(const EpochReport& report, Fault& fault) const {
  const double contact2 = report.contact_frequency2;
  const double element2 = 4.0 / (critical_.step * critical_.step);
  const double step = 2.0 / std::sqrt(element2 + contact2);
  const std::string fell = fault.kind == FaultKind::step_collapsed
                               ? fmt::format("the critical step fell to {:.3g}, which is {:.2g} of the first one", step,
                                             step / model_.first_critical_step)
                               : fmt::format("no step is stable to the end of an epoch, not even {:.3g}", report.dt);
  fault.element = critical_.element;
  fault.body = contact::body_of_element(model_, fault.element);
  if (contact2 > element2 && report.stiffest_wall != no_index) {
    const bool has_mass = model_.walls[at(report.stiffest_wall)].body != no_index;
    fault.node = report.stiffest_node;
    fault.element = element_at(model_, fault.node);
    fault.body = model_.node_body[at(fault.node)];
    fault.message = fmt::format("{}, through the stiffness of {} on {}", fell, wall_text(model_, report.stiffest_wall),
                                node_text(model_, fault.node));
    fault.cure =
        fmt::format("lower the stiffness of the wall, or give {} mass{}",
                    has_mass ? "it more" : "the light nodes that touch it", has_mass ? "" : " by run.minimum_step");
  } else if (contact2 > element2) {
    fault.node = report.stiffest_node;
    fault.element = report.stiffest_element;
    fault.body = model_.node_body[at(fault.node)];
    fault.other = contact::body_of_element(model_, fault.element);
    fault.message = fmt::format("{}, through the stiffness of contact: {} with {}", fell, node_text(model_, fault.node),
                                element_text(model_, fault.element));
    fault.cure =
        "lower contact.stiffness or contact.penalty_scale, or give the light nodes there mass by run.minimum_step";
  } else if (model_.bodies[at(fault.body)].rigid != no_index) {
    fault.element = no_index;
    fault.message =
        fmt::format("{}, because the rigid body \"{}\" turns too fast", fell, model_.bodies[at(fault.body)].name);
    fault.cure = "check its inertia and what turns it, or lower run.step_collapse if it is to turn that fast";
  } else {
    fault.message = fmt::format("{}, at {}", fell, element_text(model_, fault.element));
    fault.cure = "the element is crushed or torn: refine the mesh there, lower the load, or let elements fail";
  }
}

void Simulation::describe_drift(const EpochReport& report, Fault& fault) const {
  const Culprit culprit = watchdog_.worst(notices_);
  fault.body = culprit.body;
  fault.other = culprit.other;
  fault.share = culprit.share;
  std::string where;
  const std::string walls = walls_text(model_, workspace_.actions[at(culprit.body)]);
  if (const Index wall = model_.bodies[at(culprit.body)].wall; wall != no_index) {
    where = "at " + wall_text(model_, wall);
    fault.cure =
        "lower run.safety or the stiffness of the wall, or raise run.energy_drift_limit if the imbalance is "
        "expected";
  } else if (culprit.other == no_index) {
    fault.element = most_strained(model_, state_, culprit.body);
    where = fmt::format("inside one body{}, most strained: {}", walls.empty() ? "" : " or where it is on " + walls,
                        element_text(model_, fault.element));
    fault.cure =
        "lower run.safety, refine the mesh there, or raise run.energy_drift_limit if the imbalance is expected";
  } else {
    where = "by contact of " + pair_text(model_, culprit.body, culprit.other);
    const Touch touch = hardest_touch(model_, state_, workspace_.contact.force, culprit.body, culprit.other);
    if (touch.node != no_index) {
      fault.node = touch.node;
      fault.element = touch.element;
      where += fmt::format(", hardest: {} with {}", node_text(model_, touch.node), element_text(model_, touch.element));
    }
    fault.cure = report.deepest > sudden
                     ? "raise contact.penalty_scale, or lower run.safety"
                     : "lower run.safety or contact.penalty_scale, refine the meshes there, or raise "
                       "run.energy_drift_limit if the imbalance is expected";
  }
  fault.message =
      fmt::format("step {}: the energy balance is off by {:.3g} (bound {:.3g}), {:.0f} % of it {}", state_.step,
                  report.energy_error, model_.run.energy_drift_limit, 100.0 * culprit.share, where);
}

void Simulation::add_history(Fault& fault) const {
  if (fault.body == no_index) {
    return;
  }
  fault.epochs = watchdog_.epochs();
  fault.rows = watchdog_.rows(fault.body);
  if (fault.other != no_index && fault.other != fault.body) {
    fault.rows_other = watchdog_.rows(fault.other);
  }
}

}  // namespace fexp::cluster
