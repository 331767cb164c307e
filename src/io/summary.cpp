// SPDX-License-Identifier: Apache-2.0
#include "io/summary.hpp"

#include <nlohmann/json.hpp>
#include <system_error>

#include "io/atomic_file.hpp"

namespace fexp::io {

namespace {

using nlohmann::ordered_json;

ordered_json run_part(const Summary& s) {
  return {{"completed", s.completed},
          {"exit_reason", s.exit_reason},
          {"message", s.message},
          {"title", s.title},
          {"steps", s.steps},
          {"time", s.time},
          {"duration", s.duration},
          {"elements", s.elements},
          {"nodes", s.nodes},
          {"bodies", s.bodies},
          {"threads", s.threads},
          {"ranks", s.ranks},
          {"energy_error", s.energy_error},
          {"linear_momentum_error", s.linear_momentum_error},
          {"angular_momentum_error", s.angular_momentum_error},
          {"state_hash", s.state_hash},
          {"wall_seconds", s.wall_seconds},
          {"element_steps_per_second", s.element_steps_per_second}};
}

ordered_json energies_part(const Summary::Energies& e) {
  return {{"kinetic", e.kinetic},   {"internal", e.internal}, {"contact", e.contact},   {"barrier", e.barrier},
          {"external", e.external}, {"damping", e.damping},   {"friction", e.friction}, {"balance", e.balance}};
}

ordered_json fault_part(const Summary::FaultPlace& f) {
  ordered_json json = ordered_json::object();
  if (f.element >= 0) {
    json["element"] = f.element;
  }
  if (f.node >= 0) {
    json["node"] = f.node;
  }
  if (!f.body.empty()) {
    json["body"] = f.body;
  }
  if (!f.other_body.empty()) {
    json["other_body"] = f.other_body;
  }
  if (f.share) {
    json["share"] = *f.share;
  }
  json["cure"] = f.cure;
  json["history"] = ordered_json::array();
  for (const Summary::FaultPlace::Row& row : f.history) {
    json["history"].push_back({{"step", row.step},
                               {"time", row.time},
                               {"dt", row.dt},
                               {"energy_error", row.energy_error},
                               {"kinetic", row.kinetic},
                               {"internal", row.internal},
                               {"contact_work", row.contact_work},
                               {"off", row.off}});
  }
  return json;
}

ordered_json ties_part(const std::vector<Summary::Tie>& ties) {
  ordered_json list = ordered_json::array();
  for (const Summary::Tie& tie : ties) {
    list.push_back({{"name", tie.name}, {"tied", tie.tied}, {"far", tie.far}, {"broken", tie.broken}});
  }
  return list;
}

ordered_json added_mass_part(const std::vector<Summary::AddedMass>& parts) {
  ordered_json list = ordered_json::array();
  for (const Summary::AddedMass& part : parts) {
    list.push_back({{"body", part.body}, {"part", part.part}, {"mass", part.mass}, {"added", part.added}});
  }
  return list;
}

ordered_json penetration_list(const std::vector<Summary::Penetration>& list) {
  ordered_json json = ordered_json::array();
  for (const Summary::Penetration& p : list) {
    json.push_back({{"body", p.body},
                    {"other_body", p.other_body},
                    {"count", p.count},
                    {"depth", p.depth},
                    {"contact_distance", p.contact_distance},
                    {"nodes", p.nodes},
                    {"elements", p.elements},
                    {"crossings", p.crossings},
                    {"crossing_body", p.crossing_body},
                    {"crossing", p.crossing},
                    {"wall", p.wall}});
  }
  return json;
}

ordered_json penetrations_part(const Summary::InitialPenetrations& p) {
  ordered_json json = {{"found", penetration_list(p.found)}, {"removed", p.removed}};
  if (p.removed) {
    json["moved_nodes"] = p.moved_nodes;
    json["largest_move"] = p.largest_move;
    json["farthest_node"] = p.farthest_node;
    json["left"] = penetration_list(p.left);
  }
  return json;
}

ordered_json placement_part(const Summary::Placement& p) {
  ordered_json machines = ordered_json::array(), frames = ordered_json::array();
  for (const auto& machine : p.machines) {
    machines.push_back({{"name", machine.name},
                        {"threads", machine.threads},
                        {"native_threads", machine.native_threads},
                        {"running_threads", machine.running_threads},
                        {"busy_seconds", machine.busy_seconds}});
  }
  for (const auto& frame : p.frames) {
    frames.push_back({{"step", frame.step},
                      {"time", frame.time},
                      {"reason", frame.reason},
                      {"elements", frame.elements},
                      {"nodes", frame.nodes},
                      {"moved_elements", frame.moved_elements},
                      {"moved_nodes", frame.moved_nodes}});
  }
  return {{"machines", machines},
          {"frames", frames},
          {"frames_left_out", p.frames_left_out},
          {"moved_elements", p.moved_elements},
          {"moved_nodes", p.moved_nodes},
          {"moved_ratio", p.moved_ratio},
          {"moved_bytes", p.moved_bytes}};
}

ordered_json network_part(const Summary::Network& n) {
  return {{"messages_per_epoch", n.messages_per_epoch},
          {"bytes_per_epoch", n.bytes_per_epoch},
          {"waiting_share", n.waiting_share},
          {"snapshot_share", n.snapshot_share},
          {"imbalance", n.imbalance},
          {"largest_island_share", n.largest_island_share},
          {"time_with_one_more", n.time_with_one_more},
          {"useful_machines", n.useful_machines},
          {"balance", n.balance}};
}

}  // namespace

ordered_json to_json(const Summary& s) {
  ordered_json json = run_part(s);
  if (s.residual) {
    json["residual"] = *s.residual;
  }
  json["energies"] = energies_part(s.energies);
  json["step_smallest"] = s.step_smallest;
  json["step_largest"] = s.step_largest;
  json["frames"] = s.frames;
  json["epochs"] = s.epochs;
  json["rollbacks"] = s.rollbacks;
  json["retries"] = s.retries;
  json["islands_fewest"] = s.islands_fewest;
  json["islands_most"] = s.islands_most;
  json["contacts_most"] = s.contacts_most;
  json["searches"] = s.searches;
  json["deepest_penetration"] = s.deepest_penetration;
  json["added_mass"] = added_mass_part(s.added_mass);
  json["ties"] = ties_part(s.ties);
  json["initial_penetrations"] = penetrations_part(s.initial_penetrations);
  json["kernel"] = s.kernel;
  if (s.exit_reason == "fault") {
    json["fault"] = fault_part(s.fault);
  }
  json["placement"] = placement_part(s.placement);
  json["network"] = network_part(s.network);
  ordered_json files = ordered_json::object();
  for (const auto& [what, path] : s.files) {
    files[what] = path;
  }
  json["files"] = std::move(files);
  return json;
}

bool is_completed(const std::filesystem::path& summary) {
  std::error_code error;
  if (!std::filesystem::exists(summary, error)) {
    return false;
  }
  const auto json = nlohmann::json::parse(read_whole(summary), nullptr, false);
  return json.is_object() && json.value("completed", false);
}

void write_summary(const std::filesystem::path& path, const Summary& summary) {
  // Names in the deck may hold bytes that are no UTF-8: replaced rather than refused.
  write_atomically(path, to_json(summary).dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace fexp::io
