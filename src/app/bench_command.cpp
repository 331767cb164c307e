// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/bench_report.hpp"
#include "app/command.hpp"
#include "app/options.hpp"
#include "app/print.hpp"
#include "app/progress.hpp"
#include "bench/arithmetic.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "solve/kernels.hpp"

namespace fexp::app {

namespace {

struct BenchOptions {
  std::vector<int> threads;
  double seconds{};
  std::string filter;
  std::string csv;
  bool quick{};
  bool json{};
  bool quiet{};
};

/// One thread, and as many as the machine has.
std::vector<int> usual_threads() {
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  return all > 1 ? std::vector{1, all} : std::vector{1};
}

/// The cases and what they are measured with.
struct BenchPlan {
  std::vector<bench::StepCase> steps;
  std::vector<bench::SearchCase> searches;
  std::vector<int> threads;  // Each once; cases for one number take the first
  double seconds{};
  double triad_factor{};

  explicit BenchPlan(const BenchOptions& options)
      : steps(bench::step_cases(options.quick)),
        searches(bench::search_cases(options.quick)),
        seconds(options.seconds > 0.0 ? options.seconds
                : options.quick       ? 0.03
                                      : 1.0),
        triad_factor(options.quick ? 1.0 : 4.0) {
    for (const int number : options.threads.empty() ? usual_threads() : options.threads) {
      if (std::ranges::find(threads, number) == threads.end()) {
        threads.push_back(number);
      }
    }
    const auto is_left_out = [&](const auto& one) { return one.name.find(options.filter) == std::string::npos; };
    std::erase_if(steps, is_left_out);
    std::erase_if(searches, is_left_out);
  }

  [[nodiscard]] std::vector<int> threads_of(const bench::StepCase& step_case) const {
    return step_case.on_all_threads ? threads : std::vector{threads.front()};
  }
};

/// "plate, four_spheres, ..."
std::string case_names() {
  std::vector<std::string> names;
  for (const bench::StepCase& one : bench::step_cases(true)) {
    if (std::ranges::find(names, one.name) == names.end()) {
      names.push_back(one.name);
    }
  }
  for (const bench::SearchCase& one : bench::search_cases(true)) {
    names.push_back(one.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string processor_name(std::string_view kernel) {
  const io::Versions versions = io::present_versions(kernel);
  const auto line = std::ranges::find(versions.lines, "processor", &std::pair<std::string, std::string>::first);
  return line == versions.lines.end() ? "unknown" : line->second;
}

class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options), plan_(options) {
    if (!options.csv.empty()) {
      table_.emplace(options.csv);
    }
  }

  BenchReport measure() {
    measure_machine();
    for (const bench::StepCase& one : plan_.steps) {
      tell(fmt::format("{}: building\n", one.name));
      const bench::StepMeasurement measurement(one);
      for (const int threads : plan_.threads_of(one)) {
        take(measurement.measure(threads, plan_.seconds));
        tell(fmt::format("{}, {} triangles, {}: {}\n", one.name, report_.steps.back().elements, threads_text(threads),
                         rate_text(report_.steps.back().element_steps.median)));
      }
    }
    for (const bench::SearchCase& one : plan_.searches) {
      for (const int threads : plan_.threads) {
        report_.searches.push_back(bench::measure_search(one, threads, plan_.seconds));
        const bench::SearchRow& row = report_.searches.back();
        if (table_) {
          table_->add(report_.machine, row);
        }
        tell(fmt::format("{}, {} triangles, {}: {:.2f} million elements/s\n", one.name, row.elements,
                         threads_text(threads), 1.0e-6 * row.searches.median));
      }
    }
    if (table_) {
      table_->close();
    }
    return std::move(report_);
  }

 private:
  void measure_machine() {
    BenchMachine& machine = report_.machine;
    machine.instruction_set = solve::select_element_kernel(solve::KernelChoice::automatic).name;
    machine.processor = processor_name(machine.instruction_set);
    machine.hardware_threads = static_cast<int>(std::thread::hardware_concurrency());
    machine.cache_bytes = bench::last_cache_bytes();
    const std::size_t array_bytes = bench::triad_array_bytes(machine.cache_bytes, plan_.triad_factor);
    machine.array_bytes = static_cast<double>(array_bytes);
    const bench::ArithmeticKernels kernels = bench::arithmetic_kernels(machine.instruction_set);
    for (const int threads : plan_.threads) {
      machine.roofs.push_back(bench::measure_roofs(kernels, threads, array_bytes, plan_.seconds));
      const bench::Roofs& roofs = machine.roofs.back();
      tell(fmt::format("the machine, {}: triad {:.1f} GB/s, peak {:.1f} Gflop/s\n", threads_text(threads),
                       1.0e-9 * roofs.triad.best, 1.0e-9 * roofs.peak_flops()));
    }
  }

  void take(bench::StepRow row) {
    if (table_) {
      table_->add(report_.machine, row);
    }
    report_.steps.push_back(std::move(row));
  }

  void tell(const std::string& text) const {
    if (!options_.quiet) {
      print_error(text);
    }
  }

  const BenchOptions& options_;
  BenchPlan plan_;
  std::optional<BenchTable> table_;
  BenchReport report_;
};

ExitCode bench(const BenchOptions& options) {
  const BenchPlan plan(options);
  if (plan.steps.empty() && plan.searches.empty()) {
    print_error(
        fmt::format("fexp: --filter: no case has \"{}\" in its name; accepted: a part of {}; cure: leave "
                    "--filter out\n",
                    options.filter, case_names()));
    return ExitCode::wrong_input;
  }
  try {
    const BenchReport report = Bench(options).measure();
    if (options.json) {
      print_json(report.json());
    } else {
      print_out(report.text());
    }
  } catch (const io::OutputError& error) {
    throw io::OutputError(error.path(), error.message(),
                          "check the path and that there is space, or choose another with --csv");
  }
  return ExitCode::done;
}

std::function<ExitCode()> declare_bench(CLI::App& app) {
  auto options = std::make_shared<BenchOptions>();
  app.add_option("--threads", options->threads,
                 "Numbers of threads to measure with; 1 and all of the machine when left out. Small cases take the "
                 "first of them")
      ->delimiter(',')
      ->check(CLI::Range(1, 4096))
      ->option_text("N,N...");
  app.add_option("--seconds", options->seconds,
                 "Time for each of the three repetitions of every measurement; 1 when left out")
      ->check(CLI::Range(0.001, 3600.0))
      ->option_text("SECONDS");
  app.add_option("--filter", options->filter, "Only cases with this in their names")->option_text("TEXT");
  app.add_flag("--quick", options->quick, "Small models for a moment each: to see that it works, not how fast");
  add_json_option(app, options->json, "Print JSON, and nothing else, on the standard output");
  app.add_option("--csv", options->csv, "Write the rows to a file, too")->option_text("FILE");
  app.add_flag("--quiet", options->quiet, "Do not tell how far it is");
  return [options] { return bench(*options); };
}

}  // namespace

const Command bench_command{"bench", "Measure how fast this machine runs the solver, and what its hardware allows",
                            "  fexp bench                              minutes, on a machine without other work\n"
                            "  fexp bench --filter plate --threads 1,8\n"
                            "  fexp bench --json --csv rows.csv > machine.json",
                            declare_bench};

}  // namespace fexp::app
