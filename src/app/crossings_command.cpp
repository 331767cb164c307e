// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/command.hpp"
#include "app/crossing_examination.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

struct CrossingsOptions {
  std::string result;
  std::vector<std::pair<std::string, std::string>> exclude;
  int threads{};
  bool json{};
};

fs::path results_of(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? io::RunDirectory(path).results() : path;
}

ExitCode crossings(const CrossingsOptions& options) {
  ExitCode code = ExitCode::done;
  try {
    parallel::with_threads(options.threads, [&] {
      const CrossingsReport report = examine_crossings(results_of(options.result), options.exclude);
      if (options.json) {
        print_json(to_json(report));
      } else {
        print_out(report.text());
      }
      code = report.has_new() ? ExitCode::different : ExitCode::done;
    });
  } catch (const io::OutputError& error) {
    print_error(fmt::format("fexp: {}\n", error.what()));
    return ExitCode::wrong_input;
  }
  return code;
}

std::function<ExitCode()> declare_crossings(CLI::App& app) {
  auto options = std::make_shared<CrossingsOptions>();
  app.add_option("RESULT", options->result, "Directory of a run, or a results file (.vtkhdf)")->required();
  app.add_option("--exclude", options->exclude,
                 "Two bodies that may cross, or copies of arrays by the name that they share; may be given again")
      ->option_text("BODY BODY");
  add_threads_option(app, options->threads);
  add_json_option(app, options->json, "Print JSON, with all frames and pairs of bodies");
  return [options] { return crossings(*options); };
}

}  // namespace

const Command crossings_command{"crossings", "Tell in which frames surfaces have come through each other, and where",
                                "  fexp crossings four_spheres.run\n"
                                "  fexp crossings four_spheres.run --exclude a b",
                                declare_crossings};

}  // namespace fexp::app
