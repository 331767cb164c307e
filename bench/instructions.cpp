// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "bench/search_scene.hpp"
#include "cluster/simulation.hpp"
#include "contact/whole_search.hpp"
#include "model/state.hpp"
#include "parallel/parallel.hpp"

/// Steps of a scene or contact searches on one thread, for tests/instructions/count.py: it counts the instructions in
/// `counted_epoch` and `counted_search` and divides them by the numbers that are printed here.
namespace {

using fexp::Index;
using fexp::bench::Scene;
using fexp::solve::KernelChoice;

constexpr int no_such_kernel = 3;

[[gnu::noinline]] fexp::cluster::EpochReport counted_epoch(fexp::cluster::Simulation& simulation) {
  return simulation.run_epoch(HUGE_VAL);
}

struct Found {
  fexp::contact::CandidateRows nodes;
  fexp::contact::CandidateRows edges;
};

[[gnu::noinline]] void counted_search(fexp::contact::WholeSearch& search, const fexp::bench::SearchScene& scene,
                                      const fexp::model::NodeMotion* motion, Found& found) {
  const fexp::contact::Positions x{motion, 0.0};
  search.find_partners(scene.sphere, x, scene.skin);
  search.find_nodes(scene.sphere, x, scene.skin, {}, found.nodes);
  search.find_edges(x, scene.skin, {}, found.edges);
}

void print(const fexp::model::Model& model, Index steps, Index searches, Index active_pairs) {
  fmt::print("elements {}\nnodes {}\nsteps {}\nsearches {}\nactive_pairs {}\n", model.element_count(),
             model.node_count(), steps, searches, active_pairs);
}

/// One epoch of so many steps. The first four steps of the scene are not counted.
void step(Scene scene, Index elements, KernelChoice kernel, Index steps) {
  fexp::model::Model model = fexp::bench::build(scene, elements);
  model.run.epoch_steps = static_cast<int>(steps);
  fexp::cluster::Simulation simulation(model, kernel);
  simulation.run_epoch(fexp::bench::four_steps(model));
  const fexp::cluster::EpochReport report = counted_epoch(simulation);
  if (report.fault.kind != fexp::cluster::FaultKind::none || report.rollbacks != 0 || report.steps != steps) {
    throw std::runtime_error("the epoch was not done in one go: " + report.fault.message);
  }
  print(model, report.steps, report.searches, report.active_pairs);
}

/// So many searches; the first makes the tree and room for what is found.
void search(Index elements, Index count) {
  const fexp::bench::SearchScene scene(elements);
  const fexp::model::State state = fexp::model::initial_state(scene.sphere);
  fexp::contact::WholeSearch search;
  Found found;
  const std::vector<Index> bodies{0};
  search.assign(scene.sphere, bodies);
  for (Index i = 0; i < count; ++i) {
    counted_search(search, scene, state.motion.data(), found);
  }
  print(scene.sphere, 0, count, 0);
}

int run(const std::string& name, Index elements, const std::string& kernel, Index count) {
  const std::map<std::string, Scene> scenes{{"plate", Scene::plate},
                                            {"held_plate", Scene::held_plate},
                                            {"quiet_plate", Scene::quiet_plate},
                                            {"meeting_spheres", Scene::meeting_spheres}};
  const std::map<std::string, KernelChoice> kernels{
      {"scalar", KernelChoice::scalar}, {"baseline", KernelChoice::baseline}, {"avx2", KernelChoice::avx2}};
  const KernelChoice choice = kernels.at(kernel);
  if (fexp::solve::select_element_kernel(choice).elements == nullptr) {
    fmt::print(stderr, "this processor cannot run the kernel {}\n", kernel);
    return no_such_kernel;
  }
  if (name == "search") {
    search(elements, count);
  } else {
    step(scenes.at(name), elements, choice, count);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    fmt::print(stderr,
               "usage: instructions SCENE ELEMENTS KERNEL STEPS\n"
               "       instructions search ELEMENTS KERNEL SEARCHES\n");
    return 2;
  }
  int status = 1;
  try {
    fexp::parallel::with_threads(1, [&] { status = run(argv[1], std::stoi(argv[2]), argv[3], std::stoi(argv[4])); });
  } catch (const std::exception& error) {
    fmt::print(stderr, "instructions: {}\n", error.what());
  }
  return status;
}
