// SPDX-License-Identifier: Apache-2.0
#include "app/fault_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "io/vtkhdf.hpp"
#include "model/capture.hpp"
#include "model/cutout.hpp"

namespace fexp::app {

namespace {

/// Elements in the file of a neighbourhood: enough to see what surrounds the place, few enough to be sent to somebody.
constexpr Index most_elements = 4000;

std::string rows_text(const model::Model& model, const cluster::Fault& fault, Index body,
                      const std::vector<cluster::BodyRow>& rows, const std::string& unit) {
  std::string text =
      fmt::format("  body \"{}\" [{}]\n    {:>10}{:>14}{:>12}{:>14}{:>14}{:>14}{:>14}\n", model.bodies[at(body)].name,
                  unit, "step", "time", "dt", "kinetic", "internal", "contact work", "off");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const cluster::EpochRow& epoch = fault.epochs[i];
    const cluster::BodyRow& row = rows[i];
    text += fmt::format("    {:>10}{:>14.6g}{:>12.4g}{:>14.6g}{:>14.6g}{:>14.6g}{:>14.4g}\n", epoch.step, epoch.time,
                        epoch.dt, row.kinetic, row.internal, row.contact_work, row.off);
  }
  return text;
}

/// Of the pair that the fault names, where it was the one that was off the most of those its first body keeps.
std::string pair_rows_text(const model::Model& model, const cluster::Fault& fault, const std::string& unit) {
  std::string text;
  for (std::size_t i = 0; i < fault.rows.size(); ++i) {
    const cluster::BodyRow& row = fault.rows[i];
    if (fault.other != no_index && row.other == fault.other) {
      text += fmt::format("    {:>10}{:>14.6g}{:>12.4g}{:>14.6g}{:>14.4g}\n", fault.epochs[i].step,
                          fault.epochs[i].time, fault.epochs[i].dt, row.stored, row.pair_off);
    }
  }
  if (text.empty()) {
    return text;
  }
  return fmt::format("  contact with body \"{}\" [{}]\n    {:>10}{:>14}{:>12}{:>14}{:>14}\n",
                     model.bodies[at(fault.other)].name, unit, "step", "time", "dt", "stored", "off") +
         text;
}

}  // namespace

std::string history_text(const model::Model& model, const cluster::Fault& fault, const io::UnitNames& units) {
  if (fault.body == no_index || fault.rows.empty()) {
    return "";
  }
  const std::string unit = units.of("force*length");
  std::string text = "the last epochs:\n" + rows_text(model, fault, fault.body, fault.rows, unit);
  if (!fault.rows_other.empty()) {
    text += rows_text(model, fault, fault.other, fault.rows_other, unit);
  }
  return text + pair_rows_text(model, fault, unit);
}

io::Summary::FaultPlace place_of(const model::Model& model, const cluster::Fault& fault) {
  io::Summary::FaultPlace place;
  if (fault.element != no_index) {
    place.element = model.element_label[at(fault.element)];
  }
  if (fault.node != no_index) {
    place.node = model.node_label[at(fault.node)];
  }
  if (fault.body != no_index) {
    place.body = model.bodies[at(fault.body)].name;
  }
  if (fault.other != no_index) {
    place.other_body = model.bodies[at(fault.other)].name;
  }
  place.cure = fault.cure;
  if (fault.share > 0.0) {
    place.share = fault.share;
  }
  for (std::size_t i = 0; i < fault.rows.size(); ++i) {
    const cluster::EpochRow& epoch = fault.epochs[i];
    const cluster::BodyRow& row = fault.rows[i];
    place.history.push_back(
        {epoch.step, epoch.time, epoch.dt, epoch.energy_error, row.kinetic, row.internal, row.contact_work, row.off});
  }
  return place;
}

bool write_neighbourhood(const std::filesystem::path& path, const cluster::Simulation& simulation,
                         const cluster::Fault& fault) {
  const model::Model& model = simulation.model();
  if (fault.body == no_index || model.bodies[at(fault.body)].elements.size() == 0) {
    return false;
  }
  const model::State &start = simulation.epoch_start(), &now = simulation.state();
  const Index element = fault.element != no_index ? fault.element : model.bodies[at(fault.body)].elements.begin;
  const model::Cutout cutout = model::neighbourhood(model, start, element, most_elements);
  io::ResultsWriter writer(path, io::ResultsMesh(model, cutout), {.title = fault.message, .expected_frames = 2});
  model::Frame frame;
  if (start.time < now.time) {
    model::capture_into(model, start, {}, simulation.island_of_body(), frame);
    // Forces of contact are those of the last evaluation and not known of this moment.
    frame.contact_force.assign(frame.contact_force.size(), {NAN, NAN, NAN});
    writer.append(model::cut_out(frame, cutout));
  }
  model::capture_into(model, now, simulation.workspace().contact.force, simulation.island_of_body(), frame);
  writer.append(model::cut_out(frame, cutout));
  writer.close();
  return true;
}

}  // namespace fexp::app
