// SPDX-License-Identifier: Apache-2.0
#include "app/placement_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "app/balance_text.hpp"

namespace fexp::app {

namespace {

using Placement = io::Summary::Placement;

constexpr std::size_t most_rows = 20;

std::string frame_row(const Placement& placement, const Placement::FrameLine& frame) {
  std::string text = fmt::format("  {:<12.6g}", frame.time);
  for (std::size_t m = 0; m < placement.machines.size(); ++m) {
    text += m < frame.elements.size() ? fmt::format("{:>9} / {:<7}", frame.elements[m], frame.nodes[m])
                                      : fmt::format("{:>19}", "not connected ");
  }
  return text + fmt::format("{:>9} / {:<7} {}\n", frame.moved_elements, frame.moved_nodes, frame.reason);
}

}  // namespace

Placement placement_of(const cluster::Simulation& simulation) {
  const cluster::PlacementLedger& ledger = simulation.ledger();
  Placement placement;
  const cluster::WorldLoad load = simulation.load();
  for (std::size_t m = 0; m < simulation.world().machines.size(); ++m) {
    const cluster::Machine& machine = simulation.world().machines[m];
    placement.machines.push_back(
        {machine.name, machine.threads, machine.native_threads, load.running_threads[m], load.busy_seconds[m]});
  }
  for (const cluster::PlacementFrame& frame : ledger.frames()) {
    placement.frames.push_back({frame.step,
                                frame.time,
                                frame.reason,
                                {frame.elements.begin(), frame.elements.end()},
                                {frame.nodes.begin(), frame.nodes.end()},
                                frame.moved_elements,
                                frame.moved_nodes});
  }
  placement.frames_left_out = ledger.frames_left_out();
  placement.moved_elements = ledger.moved_elements();
  placement.moved_nodes = ledger.moved_nodes();
  placement.moved_bytes = ledger.moved_bytes();
  placement.moved_ratio =
      static_cast<double>(ledger.moved_elements()) / static_cast<double>(simulation.model().element_count());
  return placement;
}

io::Summary::Network network_of(const cluster::Simulation& simulation) {
  const cluster::WorldLoad load = simulation.load();
  io::Summary::Network network;
  if (load.epochs > 0) {
    network.messages_per_epoch = static_cast<double>(load.messages) / static_cast<double>(load.epochs);
    network.bytes_per_epoch = static_cast<double>(load.message_bytes) / static_cast<double>(load.epochs);
    network.waiting_share = load.seconds > 0.0 ? load.waiting_seconds / load.seconds : 0.0;
  }
  network.imbalance = load.balance.imbalance;
  network.largest_island_share = load.balance.largest_share;
  network.time_with_one_more = load.balance.with_one_more;
  network.useful_machines = load.balance.useful_machines;
  network.balance = balance_text(load.balance);
  return network;
}

std::string placement_text(const Placement& placement, const io::UnitNames& units) {
  std::string text = fmt::format("  {:<12}", fmt::format("time [{}]", units.of("time")));
  for (const Placement::MachineLine& machine : placement.machines) {
    text += fmt::format("{:>19}", machine.name + "         ");
  }
  text += "     moved so far  why (elements / nodes)\n";
  const std::size_t rows = placement.frames.size();
  for (std::size_t i = 0; i < rows; ++i) {
    if (rows > most_rows && i == most_rows / 2) {
      i = rows - most_rows / 2;
      text += fmt::format("  ... {} more, see placement.csv\n",
                          rows - most_rows + static_cast<std::size_t>(placement.frames_left_out));
    }
    text += frame_row(placement, placement.frames[i]);
  }
  text += fmt::format("  moved: {} elements and {} nodes, {:.3g} of the model, {} bytes on the wire\n",
                      placement.moved_elements, placement.moved_nodes, placement.moved_ratio, placement.moved_bytes);
  return text;
}

void write_placement(const io::RunDirectory& directory, const io::Summary& summary, const io::UnitNames& units) {
  const Placement& placement = summary.placement;
  if (placement.machines.size() < 2) {
    return;
  }
  io::CsvWriter csv(directory.history("placement"), {{"step", ""},
                                                     {"time", units.of("time")},
                                                     {"machine", ""},
                                                     {"elements", ""},
                                                     {"nodes", ""},
                                                     {"moved_elements", ""},
                                                     {"moved_nodes", ""},
                                                     {"reason", ""}});
  for (const Placement::FrameLine& frame : placement.frames) {
    for (std::size_t m = 0; m < frame.elements.size(); ++m) {
      csv.row({frame.step, frame.time, std::string_view(placement.machines[m].name), frame.elements[m], frame.nodes[m],
               frame.moved_elements, frame.moved_nodes, std::string_view(frame.reason)});
    }
  }
  csv.close();
}

}  // namespace fexp::app
