// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <optional>
#include <vector>

#include "bench/search_scene.hpp"
#include "contact/whole_search.hpp"
#include "model/state.hpp"
#include "parallel/parallel.hpp"

/// The contact search over the nodes and elements of one sphere.
namespace {

using fexp::Index;
using fexp::bench::SearchScene;
namespace contact = fexp::contact;
namespace model = fexp::model;

/// The last sphere asked for.
const SearchScene& sphere_of(Index elements) {
  static std::optional<SearchScene> sphere;
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
  const SearchScene& scene = sphere_of(static_cast<Index>(state.range(0)));
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::KdTree tree;
    for (auto iteration : state) {
      tree.build(scene.sphere.reference_position);
    }
  });
  state.counters["triangles"] = scene.sphere.element_count();
  state.counters["builds_per_second"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["points_per_second"] =
      benchmark::Counter(scene.sphere.node_count(), benchmark::Counter::kIsIterationInvariantRate);
}

/// The tree asked by the boxes of all elements; one iteration is all of them.
void tree_queries(benchmark::State& state) {
  const SearchScene& scene = sphere_of(static_cast<Index>(state.range(0)));
  std::vector<Index> found;
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::KdTree tree;
    tree.build(scene.sphere.reference_position);
    for (auto iteration : state) {
      fexp::bench::ask_all(tree, scene.boxes, found);
      benchmark::DoNotOptimize(found.data());
      benchmark::ClobberMemory();
    }
  });
  double all = 0.0;
  for (const Index count : found) {
    all += count;
  }
  const auto queries = static_cast<double>(scene.boxes.size());
  state.counters["triangles"] = scene.sphere.element_count();
  state.counters["queries_per_second"] = benchmark::Counter(queries, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["points_per_query"] = all / queries;
}

/// The whole search: build, queries, distances and sorted rows.
void candidate_search(benchmark::State& state) {
  const SearchScene& scene = sphere_of(static_cast<Index>(state.range(0)));
  contact::CandidateRows found;
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    contact::WholeSearch search;
    const std::vector<Index> bodies{0};
    const auto motion = model::initial_state(scene.sphere).motion;
    search.assign(scene.sphere, bodies);
    for (auto iteration : state) {
      const contact::Positions x{motion.data(), 0.0};
      search.find_partners(scene.sphere, x, scene.skin);
      search.find_nodes(scene.sphere, x, scene.skin, {}, found);
    }
  });
  const double elements = scene.sphere.element_count();
  state.counters["triangles"] = elements;
  state.counters["searches_per_second"] = benchmark::Counter(1.0, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["elements_per_second"] = benchmark::Counter(elements, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["candidates_per_element"] = static_cast<double>(found.partner.size()) / elements;
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
