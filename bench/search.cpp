// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <optional>
#include <vector>

#include "cases.hpp"
#include "contact/candidates.hpp"
#include "model/state.hpp"
#include "parallel/parallel.hpp"

/// The contact search over the nodes and elements of one sphere.
namespace {

using fexp::at;
using fexp::Box;
using fexp::Index;
using fexp::Vec3d;
namespace contact = fexp::contact;
namespace model = fexp::model;

struct Sphere {
  explicit Sphere(Index elements) {
    model::Description d;
    d.run.duration = 1.0;
    d.materials.push_back({"steel", fexp::physics::LinearElastic{7850.0, 2.1e11, 0.3}, {}});
    const int cells = static_cast<int>(std::lround(std::sqrt(static_cast<double>(elements) / 12.0)));
    d.sections.push_back({"shell", "steel", fexp::bench::relative_thickness * fexp::bench::sphere_width(cells), {}});
    const model::CubedSphere mesh{fexp::bench::sphere_radius, cells};
    d.bodies.push_back(fexp::bench::body("sphere", mesh));
    fexp::ErrorList errors;
    const std::vector<model::Mesh> meshes{model::generate_mesh(mesh)};
    whole = model::build_model(d, meshes, errors);
    motion = model::initial_state(whole).motion;
    skin = 0.4 * whole.node_size.front();
    for (const auto& t : whole.triangle) {
      Box box;
      for (const Index n : t) {
        box.include(whole.reference_position[at(n)]);
      }
      boxes.push_back(box.grown(whole.half_thickness.front() + skin));
    }
  }

  model::Model whole;
  std::vector<model::NodeMotion> motion;
  std::vector<Box> boxes;  // Of the elements, as the search grows them
  double skin{};
};

/// The last sphere asked for.
const Sphere& sphere_of(Index elements) {
  static std::optional<Sphere> sphere;
  static Index present{};
  if (!sphere || present != elements) {
    sphere.reset();
    sphere.emplace(elements);
    present = elements;
  }
  return *sphere;
}

/// Points sorted into a tree; one iteration is one build.
void tree_build(benchmark::State& state) {
  const Sphere& sphere = sphere_of(static_cast<Index>(state.range(0)));
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::KdTree tree;
    for (auto iteration : state) {
      tree.build(sphere.whole.reference_position);
    }
  });
  state.counters["triangles"] = sphere.whole.element_count();
  state.counters["builds_per_second"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["points_per_second"] =
      benchmark::Counter(sphere.whole.node_count(), benchmark::Counter::kIsIterationInvariantRate);
}

/// The tree asked by the boxes of all elements; one iteration is all of them.
void tree_queries(benchmark::State& state) {
  const Sphere& sphere = sphere_of(static_cast<Index>(state.range(0)));
  std::vector<Index> found(sphere.boxes.size());
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::KdTree tree;
    tree.build(sphere.whole.reference_position);
    for (auto iteration : state) {
      fexp::parallel::for_each(static_cast<Index>(sphere.boxes.size()), 256, [&](Index i) {
        Index count = 0;
        tree.query(sphere.boxes[at(i)], [&](Index) { ++count; });
        found[at(i)] = count;
      });
      benchmark::DoNotOptimize(found.data());
      benchmark::ClobberMemory();
    }
  });
  double all = 0.0;
  for (const Index count : found) {
    all += count;
  }
  const auto queries = static_cast<double>(sphere.boxes.size());
  state.counters["triangles"] = sphere.whole.element_count();
  state.counters["queries_per_second"] = benchmark::Counter(queries, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["points_per_query"] = all / queries;
}

/// The whole search: build, queries, distances and sorted rows.
void candidate_search(benchmark::State& state) {
  const Sphere& sphere = sphere_of(static_cast<Index>(state.range(0)));
  contact::Candidates found;
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::CandidateSearch search;
    const std::vector<Index> bodies{0};
    search.assign(sphere.whole, bodies);
    for (auto iteration : state) {
      search.search(sphere.whole, {sphere.motion.data(), 0.0}, sphere.skin, {}, found);
    }
  });
  const double elements = sphere.whole.element_count();
  state.counters["triangles"] = elements;
  state.counters["searches_per_second"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["elements_per_second"] = benchmark::Counter(elements, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["candidates_per_element"] = static_cast<double>(found.element.size()) / elements;
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"elements", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
  b->ArgsProduct({{1000, 10'000, 100'000, 1'000'000}, {1, 2}})->MinTime(0.1);
}

}  // namespace

BENCHMARK(tree_build)->Apply(sizes);
BENCHMARK(tree_queries)->Apply(sizes);
BENCHMARK(candidate_search)->Apply(sizes);
BENCHMARK_MAIN();
