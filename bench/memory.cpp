// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

#include "bench/heap.hpp"
#include "bench/scenes.hpp"
#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"
#include "resident_memory.hpp"

/// Memory of a model and its run, in bytes per element. The resident memory is the process's largest, so every case
/// needs a process of its own, which run.py sees to.
namespace {

using fexp::Index;
using fexp::bench::heap_bytes;
using fexp::bench::Scene;

void memory(benchmark::State& state, Scene scene) {
  const double resident_before = fexp::bench::most_resident_bytes();
  for (auto iteration : state) {
    fexp::parallel::with_threads(2, [&] {
      const double at_start = heap_bytes();
      const fexp::model::Model model = fexp::bench::build(scene, static_cast<Index>(state.range(0)));
      const double with_model = heap_bytes();
      double state_bytes = 0.0, workspace_bytes = 0.0;
      {
        const fexp::model::State initial = fexp::model::initial_state(model);
        const double with_state = heap_bytes();
        state_bytes = with_state - with_model;
        const fexp::solve::Workspace workspace(
            model, fexp::solve::select_element_kernel(fexp::solve::KernelChoice::automatic));
        workspace_bytes = heap_bytes() - with_state;
      }
      fexp::cluster::Simulation simulation(model, fexp::solve::KernelChoice::automatic);
      simulation.run_epoch(fexp::bench::four_steps(model));
      const double elements = model.element_count();
      state.counters["triangles"] = elements;
      state.counters["model"] = (with_model - at_start) / elements;
      state.counters["state"] = state_bytes / elements;
      state.counters["workspace"] = workspace_bytes / elements;
      state.counters["run"] = (heap_bytes() - at_start) / elements;
      state.counters["resident"] = (fexp::bench::most_resident_bytes() - resident_before) / elements;
    });
  }
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgName("elements")->RangeMultiplier(10)->Range(10'000, 1'000'000)->Iterations(1);
}

}  // namespace

BENCHMARK_CAPTURE(memory, plate, Scene::plate)->Apply(sizes);
BENCHMARK_CAPTURE(memory, quiet_plate, Scene::quiet_plate)->Apply(sizes);
BENCHMARK_CAPTURE(memory, separate_spheres, Scene::separate_spheres)->Apply(sizes);
BENCHMARK_CAPTURE(memory, meeting_spheres, Scene::meeting_spheres)->Apply(sizes);
BENCHMARK_MAIN();
