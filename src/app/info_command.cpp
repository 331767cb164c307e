// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "io/output_error.hpp"
#include "io/vtkhdf_info.hpp"

namespace fexp::app {

namespace {

struct InfoOptions {
  std::string result;
  bool json{};
};

ExitCode info(const InfoOptions& options) {
  try {
    const io::ResultsInfo info = io::read_info(options.result);
    if (options.json) {
      print_json(io::to_json(info));
    } else {
      print_out(info.text());
    }
  } catch (const io::OutputError& error) {
    print_error(fmt::format("fexp: {}\n", error.what()));
    return ExitCode::wrong_input;
  }
  return ExitCode::done;
}

std::function<ExitCode()> declare_info(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  app.add_option("RESULT", options->result, "Directory of a run, or a results file (.vtkhdf)")->required();
  add_json_option(app, options->json, "Print JSON");
  return [options] { return info(*options); };
}

}  // namespace

const Command info_command{"info", "Tell what a run or a results file holds", "  fexp info four_spheres.run",
                           declare_info};

}  // namespace fexp::app
