// SPDX-License-Identifier: Apache-2.0
#include "app/run_summary.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "app/fault_report.hpp"
#include "app/penetrations.hpp"
#include "app/placement_report.hpp"
#include "app/progress.hpp"
#include "model/added_mass.hpp"
#include "model/tie_forces.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

void add_extremes(const cluster::RunExtremes& x, io::Summary& summary) {
  summary.energy_error = x.energy_error;
  summary.linear_momentum_error = x.linear_momentum_error;
  summary.angular_momentum_error = x.angular_momentum_error;
  summary.step_smallest = x.largest_dt > 0.0 ? x.smallest_dt : 0.0;
  summary.step_largest = x.largest_dt;
  summary.epochs = x.epochs;
  summary.rollbacks = x.rollbacks;
  summary.retries = x.retries;
  summary.islands_fewest = x.fewest_islands;
  summary.islands_most = x.most_islands;
  summary.contacts_most = x.most_active_pairs;
  summary.searches = x.searches;
  summary.deepest_penetration = x.deepest;
}

std::string energies_text(const solve::Energies& a, const solve::Energies& b, const std::string& unit) {
  const auto line = [](const char* name, double at_start, double at_end) {
    return fmt::format("    {:<12}{:>14.6g}{:>14.6g}\n", name, at_start, at_end);
  };
  return fmt::format("  energy [{}]   at the start    at the end\n", unit) + line("kinetic", a.kinetic, b.kinetic) +
         line("internal", a.internal, b.internal) +
         (b.dissipated > 0.0 ? line("  dissipated", a.dissipated, b.dissipated) : "") +
         line("contact", a.contact, b.contact) + line("barrier", a.barrier, b.barrier) +
         line("damping", a.damping, b.damping) + line("friction", a.friction, b.friction) +
         line("external", a.external, b.external) + line("balance", a.balance(), b.balance());
}

std::string added_mass_text(const io::Summary::AddedMass& part, const std::string& unit) {
  const double share = part.added / part.mass;
  return fmt::format("  {}mass scaling added {:.4g} {} to part \"{}\" of body \"{}\", {:.2g} %\n",
                     share > model::much_added_mass ? "warning: " : "", part.added, unit, part.part, part.body,
                     100.0 * share);
}

/// Names of all files but the directory's, which they share.
std::string files_text(const io::Summary& summary) {
  if (summary.files.empty()) {
    return "";
  }
  std::string text =
      "  files      in " + std::filesystem::path(summary.files.front().second).parent_path().string() + ":";
  for (const auto& [what, path] : summary.files) {
    text += " " + std::filesystem::path(path).filename().string();
  }
  return text + "\n";
}

}  // namespace

io::Summary summarise(const Case& loaded, const cluster::Simulation& simulation, const RunEnd& end) {
  const model::Model& model = loaded.model;
  const model::State& state = simulation.state();
  io::Summary summary;
  summary.completed = end.reason == EndReason::completed;
  summary.exit_reason = name_of(end.reason);
  summary.message = end.message;
  summary.title = loaded.deck.title;
  summary.steps = state.step;
  summary.time = state.time;
  summary.duration = model.run.duration;
  summary.elements = model.element_count();
  summary.nodes = model.node_count();
  summary.bodies = model.body_count();
  summary.threads = parallel::thread_count();
  summary.state_hash = fmt::format("{:016x}", model::state_hash(model, state));
  summary.element_steps_per_second = end.stepping_seconds > 0.0
                                         ? static_cast<double>(state.step - end.first_step) *
                                               static_cast<double>(model.element_count()) / end.stepping_seconds
                                         : 0.0;
  const solve::Energies& e = end.last.diagnostics.energies;
  summary.energies = {e.kinetic, e.internal, e.contact, e.barrier, e.external, e.damping, e.friction, e.balance()};
  if (model.run.is_static()) {
    summary.residual = simulation.relaxation().residual();
  }
  summary.kernel = simulation.workspace().kernel.name;
  add_extremes(simulation.extremes(), summary);
  for (const model::AddedMass& part : model::added_masses(model)) {
    summary.added_mass.push_back({part.body, part.part, part.mass, part.added});
  }
  for (std::size_t t = 0; t < model.ties.results.size(); ++t) {
    const model::TieResult& tie = model.ties.results[t];
    summary.ties.push_back({tie.name, tie.tied, static_cast<std::int64_t>(tie.far.size()),
                            model::broken_ties(model, state, static_cast<Index>(t))});
  }
  summary.initial_penetrations = loaded.penetrations;
  summary.placement = placement_of(simulation);
  summary.network = network_of(simulation);
  if (end.reason == EndReason::fault) {
    summary.fault = place_of(model, end.fault);
  }
  return summary;
}

std::string summary_text(const io::Summary& s, const io::UnitNames& units, const solve::Diagnostics& start,
                         const solve::Diagnostics& present) {
  std::string text = fmt::format("{}{}{}\n", s.title, s.title.empty() ? "" : ": ", s.exit_reason);
  text += fmt::format("  model      {} elements, {} nodes, {} bodies, {} to {} islands\n", s.elements, s.nodes,
                      s.bodies, s.islands_fewest, s.islands_most);
  text += fmt::format("  time       {:.6g} of {:.6g} {}, {} steps of {:.4g} to {:.4g}\n", s.time, s.duration,
                      units.of("time"), s.steps, s.step_smallest, s.step_largest);
  if (s.residual) {
    text += fmt::format("  static     residual {:.2e}\n", *s.residual);
  }
  for (const io::Summary::AddedMass& part : s.added_mass) {
    text += added_mass_text(part, units.of("mass"));
  }
  for (const io::Summary::Tie& tie : s.ties) {
    text += fmt::format("  tie        \"{}\" holds {} nodes{}{}\n", tie.name, tie.tied - tie.broken,
                        tie.broken > 0 ? fmt::format(", {} are broken", tie.broken) : "",
                        tie.far > 0 ? fmt::format("; warning: {} are too far from its surface and free", tie.far) : "");
  }
  for (const std::string& line : penetration_lines(s.initial_penetrations)) {
    text += "  " + line + "\n";
  }
  text += energies_text(start.energies, present.energies, units.of("force*length"));
  text +=
      fmt::format("  errors     energy {:.2e}, linear momentum {:.2e}, angular momentum {:.2e} (largest, relative)\n",
                  s.energy_error, s.linear_momentum_error, s.angular_momentum_error);
  const Vec3d& p = present.momenta.linear;
  const Vec3d& l = present.momenta.angular;
  text += fmt::format("  momentum   linear ({:.6g}, {:.6g}, {:.6g}) {}, angular ({:.6g}, {:.6g}, {:.6g}) {}\n", p.x,
                      p.y, p.z, units.of("force*time"), l.x, l.y, l.z, units.of("force*length*time"));
  text += fmt::format("  contact    at most {} pairs, deepest {:.1f} % of the contact distance, {} searches\n",
                      s.contacts_most, 100.0 * s.deepest_penetration, s.searches);
  if (s.retries > 0) {
    text += fmt::format("  retries    {} {} done again with half the step, see log.txt\n", s.retries,
                        s.retries == 1 ? "epoch was" : "epochs were");
  }
  if (present.deleted > 0) {
    text += fmt::format("  deleted    {} elements\n", present.deleted);
  }
  text += fmt::format("  wall time  {} with {} {} ({} kernel), {}\n", wall_time_text(s.wall_seconds), s.threads,
                      s.threads == 1 ? "thread" : "threads", s.kernel, rate_text(s.element_steps_per_second));
  text += fmt::format("  state      {} after step {}\n", s.state_hash, s.steps);
  if (s.placement.machines.size() > 1) {
    text += placement_text(s.placement, units);
    text += fmt::format("  network    {:.3g} messages and {:.4g} bytes an epoch, {:.1f} % of the time waiting\n",
                        s.network.messages_per_epoch, s.network.bytes_per_epoch, 100.0 * s.network.waiting_share);
    text += "  balance    " + s.network.balance + "\n";
  }
  return text + files_text(s);
}

}  // namespace fexp::app
