// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <optional>

#include "bench/scenes.hpp"
#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"

/// Whole steps, epoch by epoch as a run takes them, without output.
namespace {

using fexp::Index;
using fexp::bench::Scene;

/// The last model asked for: repetitions and numbers of threads share it.
const fexp::model::Model& model_of(Scene scene, Index elements) {
  static std::optional<fexp::model::Model> model;
  static Scene present_scene{};
  static Index present_elements{};
  if (!model || present_scene != scene || present_elements != elements) {
    model.reset();
    model.emplace(fexp::bench::build(scene, elements));
    present_scene = scene;
    present_elements = elements;
  }
  return *model;
}

struct Tally {
  double element_steps{};
  double cpu_seconds{};
  double steps{};
  double searches{};
  double active_pairs{};  ///< Summed over epochs
  double islands{};
};

void one_epoch(fexp::cluster::Simulation& simulation, benchmark::State& state, Tally& tally) {
  const std::clock_t start = std::clock();
  const fexp::cluster::EpochReport report = simulation.run_epoch(HUGE_VAL);
  tally.cpu_seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  tally.steps += report.steps;
  tally.element_steps += static_cast<double>(report.steps) * simulation.model().element_count();
  tally.searches += report.searches;
  tally.active_pairs += report.active_pairs;
  tally.islands = report.islands;
  if (report.fault.kind != fexp::cluster::FaultKind::none) {
    state.SkipWithError(report.fault.message.c_str());
  }
}

/// One iteration is an epoch. The first four steps warm up and are not timed; spheres that meet start anew for every
/// iteration, so that they are in contact throughout.
void steps(benchmark::State& state, Scene scene) {
  const fexp::model::Model& model = model_of(scene, static_cast<Index>(state.range(0)));
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    std::optional<fexp::cluster::Simulation> simulation;
    const auto start = [&] {
      simulation.emplace(model, fexp::solve::KernelChoice::automatic);
      simulation->run_epoch(fexp::bench::four_steps(model));
    };
    Tally tally;
    start();
    bool fresh = true;
    for (auto iteration : state) {
      if (scene == Scene::meeting_spheres && !fresh) {
        state.PauseTiming();
        start();
        state.ResumeTiming();
      }
      one_epoch(*simulation, state, tally);
      fresh = false;
    }
    const auto epochs = static_cast<double>(state.iterations());
    state.counters["triangles"] = model.element_count();
    state.counters["element_steps_per_second"] = benchmark::Counter(tally.element_steps, benchmark::Counter::kIsRate);
    state.counters["cpu_ns_per_element_step"] = 1.0e9 * tally.cpu_seconds / tally.element_steps;
    state.counters["searches_per_step"] = tally.searches / tally.steps;
    state.counters["active_pairs"] = tally.active_pairs / epochs;
    state.counters["islands"] = tally.islands;
  });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"elements", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
}

void add(const char* name, Scene scene) {
  // Epochs by size: enough for a time that can be taken, but the largest size once, as it takes long enough.
  for (const auto& [elements, epochs] : {std::pair{1000, 30}, {10'000, 6}, {100'000, 1}, {1'000'000, 1}}) {
    for (const int threads : {1, 2}) {
      auto* const made = benchmark::RegisterBenchmark(name, steps, scene)->Apply(sizes);
      made->Args({elements, threads})->Iterations(epochs);
      if (elements == 1'000'000) {
        made->Repetitions(1);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  add("plate", Scene::plate);
  add("quiet_plate", Scene::quiet_plate);
  add("separate_spheres", Scene::separate_spheres);
  add("meeting_spheres", Scene::meeting_spheres);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
