// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command.hpp"
#include "app/print.hpp"
#include "base/errors.hpp"
#include "coordinator/places.hpp"
#include "coordinator/probe.hpp"
#include "solve/kernels.hpp"

namespace fexp::app {

namespace {

ExitCode probe(const coordinator::ProbeRequest& request) {
  ErrorList errors;
  if (!coordinator::is_run_id(request.run_id)) {
    errors.add({}, "--run-id: \"" + request.run_id + "\" is no id of a run", "16 hexadecimal digits",
               "take it from cluster.json");
  }
  if (request.machine.empty() || request.machine.find('/') != std::string::npos || request.machine.front() == '.') {
    errors.add({}, "--machine: \"" + request.machine + "\" is no name of a machine", "a name as in \"cluster status\"",
               "take it from cluster.json");
  }
  errors.throw_if_any();
  const std::string_view kernel = solve::select_element_kernel(solve::KernelChoice::automatic).name;
  // On a line of its own, and the last one: a shell's start-up files may have printed something.
  print_out(coordinator::to_json(coordinator::probe_here(request, kernel)).dump() + "\n");
  return ExitCode::done;
}

std::function<ExitCode()> declare_probe(CLI::App& app) {
  auto request = std::make_shared<coordinator::ProbeRequest>();
  app.add_option("--run-id", request->run_id, "Id of the run")->required();
  app.add_option("--machine", request->machine, "Name that the run has for this machine")->required();
  app.add_option("--kill-below", request->kill_below, "End the run's workers of worlds below this one first");
  app.add_flag("--forget", request->forget, "Remove what the run keeps in this machine's memory");
  return [request] { return probe(*request); };
}

}  // namespace

const Command probe_command{"probe", "Tell how this machine and a run on it are; the coordinator of a cluster asks",
                            "  fexp probe --run-id 0123456789abcdef --machine c1", declare_probe, true};

}  // namespace fexp::app
