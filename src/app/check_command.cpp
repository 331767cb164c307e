// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command.hpp"
#include "app/findings_report.hpp"
#include "app/load.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/progress.hpp"
#include "app/schedule.hpp"
#include "app/trial.hpp"
#include "io/vtkhdf_fields.hpp"
#include "model/body_properties.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

constexpr double trial_seconds = 1.0;
/// Bodies told of one by one; --json tells of all.
constexpr std::size_t most_bodies = 30;

struct CheckOptions {
  std::string deck;
  int threads{};
  bool json{};
  bool strict{};
};

/// All that the command tells.
struct CheckReport {
  const Case& loaded;
  std::vector<model::BodyProperties> bodies;
  model::BodyProperties total;
  std::int64_t frames{};
  double results_bytes{};  ///< Of the results file, not compressed
  Trial trial;
  std::vector<quality::Finding> findings;

  [[nodiscard]] double step() const { return loaded.model.first_step(); }
  [[nodiscard]] const std::string& slowest_body() const {
    const Index block = loaded.model.element_block[at(loaded.model.first_critical_element)];
    return loaded.model.bodies[at(loaded.model.blocks[at(block)].body)].name;
  }
  [[nodiscard]] std::int64_t slowest_element() const {
    return loaded.model.element_label[at(loaded.model.first_critical_element)];
  }
};

double frame_bytes(const model::Model& model) {
  double bytes = static_cast<double>(sizeof(Vec3d)) * model.node_count();
  for (const io::ResultField& field : io::result_fields()) {
    if (!field.constant(io::Variety::of(model))) {
      const Index rows = field.place == io::FieldPlace::node ? model.node_count() : model.element_count();
      bytes += static_cast<double>(io::row_bytes(field)) * rows;
    }
  }
  return bytes;
}

CheckReport make_report(const Case& loaded, const std::vector<model::Mesh>& meshes) {
  CheckReport report{loaded, {}, model::total_properties(loaded.model), 0, 0.0, {}, {}};
  for (Index b = 0; b < loaded.model.body_count(); ++b) {
    report.bodies.push_back(model::body_properties(loaded.model, b));
  }
  const io::OutputSettings& output = loaded.deck.output;
  report.frames = Schedule(loaded.model.run.duration, output.results_interval, output.history_interval).frames();
  report.results_bytes = frame_bytes(loaded.model) * static_cast<double>(report.frames);
  report.trial = run_trial(loaded, trial_seconds);
  report.findings = all_findings(loaded, meshes, report.trial);
  return report;
}

std::string vector_text(const Vec3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

std::string properties_text(const model::BodyProperties& p, const io::UnitNames& units) {
  const std::string length = units.of("length"), inertia = units.of("mass") + "*" + length + "^2";
  const auto& [xx, yy, zz, xy, yz, zx] = p.inertia;
  return fmt::format("    mass {:.6g} {}, centre {} {}\n", p.mass, units.of("mass"), vector_text(p.centre), length) +
         fmt::format(
             "    inertia about the centre: xx {:.6g}, yy {:.6g}, zz {:.6g}, xy {:.6g}, yz {:.6g}, zx {:.6g} {}\n", xx,
             yy, zz, xy, yz, zx, inertia) +
         fmt::format("    from {} to {} {}\n", vector_text(p.box.low), vector_text(p.box.high), length);
}

std::string bytes_text(double bytes) {
  return bytes < 1.0e9 ? fmt::format("{:.1f} MB", 1.0e-6 * bytes) : fmt::format("{:.1f} GB", 1.0e-9 * bytes);
}

std::string bodies_text(const CheckReport& report) {
  const model::Model& model = report.loaded.model;
  std::string text;
  const std::size_t shown = std::min(model.bodies.size(), most_bodies);
  for (std::size_t b = 0; b < shown; ++b) {
    const model::Body& body = model.bodies[b];
    text += fmt::format("  body \"{}\": {} elements, {} nodes{}\n", body.name, body.elements.size(), body.nodes.size(),
                        body.barrier             ? ", fixed"
                        : body.wall != no_index  ? ", a rigid wall with mass"
                        : body.rigid != no_index ? ", rigid"
                                                 : "");
    text += properties_text(report.bodies[b], report.loaded.deck.units);
  }
  if (shown < model.bodies.size()) {
    text += fmt::format("  and {} more bodies, which --json lists\n", model.bodies.size() - shown);
  }
  text += fmt::format("  total: {} elements, {} nodes, {} bodies\n", model.element_count(), model.node_count(),
                      model.body_count());
  return text + properties_text(report.total, report.loaded.deck.units);
}

std::string report_text(const CheckReport& report) {
  const Case& loaded = report.loaded;
  const Trial& trial = report.trial;
  const std::string time = loaded.deck.units.of("time");
  std::string text = fmt::format("{}{}the deck is sound\n", loaded.deck.title, loaded.deck.title.empty() ? "" : ": ");
  text += bodies_text(report);
  text += fmt::format("  smallest step: {:.6g} {} ({:g} of the critical one), set by element {} of body \"{}\"\n",
                      report.step(), time, loaded.model.run.safety, report.slowest_element(), report.slowest_body());
  text += fmt::format("  steps: about {:.0f} for {:.6g} {} (mean step {:.4g} in the trial)\n", trial.expected_steps,
                      loaded.model.run.duration, time, trial.time / static_cast<double>(trial.steps));
  text += fmt::format("  memory: {}, results file: {} in {} frames\n", bytes_text(trial.memory_bytes),
                      bytes_text(report.results_bytes), report.frames);
  text += fmt::format("  time: about {} with {} threads, without output; trial of {} steps, {}\n",
                      wall_time_text(trial.expected_seconds), parallel::thread_count(), trial.steps,
                      rate_text(trial.element_steps_per_second));
  return text + findings_text(report.findings);
}

nlohmann::ordered_json properties_json(const model::BodyProperties& p) {
  const auto array = [](const Vec3d& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); };
  return {{"mass", p.mass},
          {"centre", array(p.centre)},
          {"inertia", p.inertia},
          {"low", array(p.box.low)},
          {"high", array(p.box.high)}};
}

nlohmann::ordered_json report_json(const CheckReport& report) {
  const model::Model& model = report.loaded.model;
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    nlohmann::ordered_json body = {{"name", model.bodies[b].name},
                                   {"elements", model.bodies[b].elements.size()},
                                   {"nodes", model.bodies[b].nodes.size()},
                                   {"barrier", model.bodies[b].barrier},
                                   {"rigid", model.bodies[b].rigid != no_index}};
    body.update(properties_json(report.bodies[b]));
    bodies.push_back(std::move(body));
  }
  const Trial& trial = report.trial;
  return {{"title", report.loaded.deck.title},
          {"elements", model.element_count()},
          {"nodes", model.node_count()},
          {"bodies", std::move(bodies)},
          {"total", properties_json(report.total)},
          {"smallest_step", report.step()},
          {"smallest_step_element", report.slowest_element()},
          {"smallest_step_body", report.slowest_body()},
          {"duration", model.run.duration},
          {"expected_steps", trial.expected_steps},
          {"expected_seconds", trial.expected_seconds},
          {"memory_bytes", trial.memory_bytes},
          {"results_bytes", report.results_bytes},
          {"frames", report.frames},
          {"threads", parallel::thread_count()},
          {"trial_steps", trial.steps},
          {"element_steps_per_second", trial.element_steps_per_second},
          {"touching_bodies", trial.touching.size()},
          {"trial_fault", trial.last.fault.message},
          {"findings", findings_json(report.findings)}};
}

bool any_warning(const std::vector<quality::Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const quality::Finding& f) { return f.severity == quality::Severity::warning; });
}

ExitCode check(const CheckOptions& options) {
  ExitCode code = ExitCode::done;
  parallel::with_threads(options.threads, [&] {
    std::vector<model::Mesh> meshes;
    const Case loaded = load_case(options.deck, meshes);
    const CheckReport report = make_report(loaded, meshes);
    if (options.json) {
      print_json(report_json(report));
    } else {
      print_out(report_text(report));
    }
    const cluster::Fault& fault = report.trial.last.fault;
    if (fault.kind != cluster::FaultKind::none) {
      print_error(fmt::format("fexp: the trial stopped: {}; cure: {}\n", fault.message, fault.cure));
      code = ExitCode::fault;
    } else if (options.strict && any_warning(report.findings)) {
      code = ExitCode::wrong_input;
    }
  });
  return code;
}

std::function<ExitCode()> declare_check(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  add_deck_option(app, options->deck);
  add_threads_option(app, options->threads);
  add_json_option(app, options->json, "Print JSON");
  app.add_flag("--strict", options->strict, "Exit with 2 when there are warnings");
  return [options] { return check(*options); };
}

}  // namespace

const Command check_command{"check",
                            "Validate a deck; tell masses, smallest step, what is odd, and how long a run will take",
                            "  fexp check four_spheres.toml", declare_check};

}  // namespace fexp::app
