// SPDX-License-Identifier: Apache-2.0
#include "cluster/placement_ledger.hpp"

namespace fexp::cluster {

const char* text_of(MoveReason reason) noexcept {
  switch (reason) {
    case MoveReason::start:
      return "start";
    case MoveReason::merge:
      return "merge";
    case MoveReason::split:
      return "split";
    case MoveReason::machine_left:
      return "machine left";
    case MoveReason::balance:
      return "balance";
  }
  return "";
}

void PlacementLedger::note(const model::Model& model, std::int64_t step, double time, const Placement& placement,
                           const std::vector<Machine>& machines, std::string reason) {
  for (const Move& move : placement.moves) {
    if (move.reason != MoveReason::start) {
      moves_.push_back({step, time, move});
      moved_elements_ += model.bodies[at(move.body)].elements.size();
      moved_nodes_ += model.bodies[at(move.body)].nodes.size();
    }
  }
  PlacementFrame frame{step, time, std::move(reason), {}, {}, moved_elements_, moved_nodes_};
  frame.elements.assign(machines.size(), 0);
  frame.nodes.assign(machines.size(), 0);
  for (Index b = 0; b < model.body_count(); ++b) {
    if (const MachineIndex owner = placement.owner[at(b)]; owner != no_machine) {
      frame.elements[static_cast<std::size_t>(owner)] += model.bodies[at(b)].elements.size();
      frame.nodes[static_cast<std::size_t>(owner)] += model.bodies[at(b)].nodes.size();
    }
  }
  if (!frames_.empty() && frames_.back().step == step) {
    // An epoch that is redone may begin with other islands.
    frame.reason = frames_.back().reason;
    frames_.pop_back();
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() > 2 * frames_kept) {
    frames_.erase(frames_.begin() + frames_kept);
    ++frames_left_out_;
  }
}

void PlacementLedger::pack(ByteWriter& out) const {
  out.value(static_cast<std::uint64_t>(frames_.size()));
  for (const PlacementFrame& frame : frames_) {
    out.value(frame.step);
    out.value(frame.time);
    out.text(frame.reason);
    out.list(frame.elements);
    out.list(frame.nodes);
    out.value(frame.moved_elements);
    out.value(frame.moved_nodes);
  }
  out.value(frames_left_out_);
  out.value(moved_elements_);
  out.value(moved_nodes_);
  out.value(moved_bytes_);
}

PlacementLedger PlacementLedger::unpack(ByteReader& in) {
  PlacementLedger ledger;
  const auto count = in.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && in.sound(); ++i) {
    PlacementFrame& frame = ledger.frames_.emplace_back();
    frame.step = in.value<std::int64_t>();
    frame.time = in.value<double>();
    frame.reason = in.text();
    frame.elements = in.list<Index>();
    frame.nodes = in.list<Index>();
    frame.moved_elements = in.value<std::int64_t>();
    frame.moved_nodes = in.value<std::int64_t>();
  }
  ledger.frames_left_out_ = in.value<std::int64_t>();
  ledger.moved_elements_ = in.value<std::int64_t>();
  ledger.moved_nodes_ = in.value<std::int64_t>();
  ledger.moved_bytes_ = in.value<std::int64_t>();
  return ledger;
}

}  // namespace fexp::cluster
