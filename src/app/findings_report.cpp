// SPDX-License-Identifier: Apache-2.0
#include "app/findings_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/penetrations.hpp"
#include "quality/assess.hpp"

namespace fexp::app {

namespace {

using quality::Finding;
using quality::Severity;

/// Output in fewer steps than this shortens them noticeably.
constexpr double few_steps = 5.0;

Finding touching_finding(const model::Model& model, const std::vector<Index>& touching) {
  Finding finding;
  finding.kind = "penetration";
  finding.count = static_cast<std::int64_t>(touching.size());
  finding.message =
      fmt::format("{} bodies penetrate something at the start, the first is \"{}\", and will be pushed apart",
                  touching.size(), model.bodies[at(touching.front())].name);
  finding.cure =
      "move them so far apart that their thicknesses do not overlap, or leave the pair out with contact.exclude";
  return finding;
}

Finding interval_finding(double interval, double step, const std::string& unit) {
  Finding finding;
  finding.kind = "output_interval";
  finding.message = fmt::format("output every {:.4g} {} is every {:.3g} steps, and steps are shortened to meet it",
                                interval, unit, interval / step);
  finding.cure = "longer output intervals make the run faster";
  finding.numbers = {{"interval", interval}, {"step", step}};
  return finding;
}

std::string ids_text(const Finding& finding) {
  if (finding.ids.empty()) {
    return "";
  }
  std::string text = fmt::format("; {}{} ", finding.item, finding.ids.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < finding.ids.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", finding.ids[i]);
    text += finding.other_ids.empty() ? "" : fmt::format(" and {}", finding.other_ids[i]);
  }
  const std::int64_t more = finding.count - static_cast<std::int64_t>(finding.ids.size());
  return more > 0 ? text + fmt::format(" and {} more", more) : text;
}

}  // namespace

std::vector<Finding> all_findings(const Case& loaded, const std::vector<model::Mesh>& meshes, const Trial& trial) {
  std::vector<Finding> findings;
  if (!trial.touching.empty()) {
    findings.push_back(touching_finding(loaded.model, trial.touching));
  }
  const double shorter = std::min(loaded.deck.output.results_interval, loaded.deck.output.history_interval);
  const double step = loaded.model.first_step();
  if (shorter < few_steps * step) {
    findings.push_back(interval_finding(shorter, step, loaded.deck.units.of("time")));
  }
  const std::vector<Finding> near = penetration_findings(loaded.penetrations);
  findings.insert(findings.end(), near.begin(), near.end());
  const std::vector<Finding> mesh = quality::assess(loaded.model, meshes);
  findings.insert(findings.end(), mesh.begin(), mesh.end());
  std::stable_partition(findings.begin(), findings.end(),
                        [](const Finding& f) { return f.severity == Severity::warning; });
  return findings;
}

std::string findings_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += finding.severity == Severity::warning ? "  warning: " : "  note: ";
    text += finding.body.empty() ? "" : fmt::format("body \"{}\": ", finding.body);
    text += finding.message + ids_text(finding);
    text += finding.cure.empty() ? "" : "; " + finding.cure;
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    nlohmann::ordered_json numbers = nlohmann::ordered_json::object();
    for (const auto& [name, value] : finding.numbers) {
      numbers[std::string(name)] = value;
    }
    list.push_back({{"kind", finding.kind},
                    {"severity", finding.severity == Severity::warning ? "warning" : "note"},
                    {"body", finding.body},
                    {"other_body", finding.other_body},
                    {"message", finding.message},
                    {"cure", finding.cure},
                    {"item", finding.item},
                    {"count", finding.count},
                    {"ids", finding.ids},
                    {"other_ids", finding.other_ids},
                    {"numbers", std::move(numbers)}});
  }
  return list;
}

}  // namespace fexp::app
