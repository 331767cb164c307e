// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>

#include "app/command.hpp"
#include "app/print.hpp"
#include "io/compare.hpp"
#include "io/output_error.hpp"

namespace fexp::app {

namespace {

struct CompareOptions {
  std::string a;
  std::string b;
};

ExitCode compare(const CompareOptions& options) {
  try {
    const io::Comparison comparison = io::compare_runs(options.a, options.b);
    print_out(comparison.text());
    return !comparison.comparable ? ExitCode::wrong_input : comparison.same ? ExitCode::done : ExitCode::different;
  } catch (const io::OutputError& error) {
    print_error(fmt::format("fexp: {}\n", error.what()));
    return ExitCode::wrong_input;
  }
}

std::function<ExitCode()> declare_compare(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  app.add_option("A", options->a, "Directory of a run, or a results file")->required();
  app.add_option("B", options->b, "Another")->required();
  return [options] { return compare(*options); };
}

}  // namespace

const Command compare_command{"compare", "Name the first step, body and node in which two runs differ, bit by bit",
                              "  fexp compare four_spheres.run four_spheres-2.run", declare_compare};

}  // namespace fexp::app
