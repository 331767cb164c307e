// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "cluster/body_notice.hpp"
#include "cluster/interaction_graph.hpp"
#include "cluster/placement.hpp"
#include "cluster/rank_record.hpp"
#include "parallel/parallel.hpp"
#include "resident_memory.hpp"

/// What every rank does at an epoch's start, for many more bodies and machines than a test has: the interaction graph
/// and the placement of its islands.
namespace {

using fexp::at;
using fexp::Box;
using fexp::Index;
using namespace fexp::cluster;
namespace model = fexp::model;

/// Elements of a body, and the canonical bytes of its state: a sphere of 192 triangles and 98 nodes.
constexpr double body_elements = 192.0;
constexpr double body_bytes = 98.0 * 15.0 * 8.0 + 192.0 * 12.0 * 8.0 + 88.0;

/// Processor time of one iteration.
double milliseconds_since(std::clock_t start, const benchmark::State& state) {
  return 1.0e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / static_cast<double>(state.iterations());
}

enum class Packing {
  pairs,  ///< Two and two overlap
  dense   ///< Every box overlaps up to 26 others, as in a heap
};

/// Boxes on a cubic grid of about unit pitch, somewhat irregular. Only bodies and contact settings of the model are
/// made.
struct Boxes {
  Boxes(Packing packing, Index count) {
    model.bodies.resize(at(count));
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> jitter(-0.01, 0.01);
    const auto side = static_cast<Index>(std::ceil(std::cbrt(static_cast<double>(count))));
    const double half = packing == Packing::dense ? 0.53 : 0.43;
    for (Index i = 0; i < count; ++i) {
      const Index x = i % side, y = i / side % side, z = i / (side * side);
      const double shift = packing == Packing::pairs && x % 2 == 1 ? -0.2 : 0.0;
      const double dx = jitter(random), dy = jitter(random), dz = jitter(random);
      const fexp::Vec3d centre{x + shift + dx, y + dy, z + dz};
      swept.push_back(Box{centre, centre}.grown(half));
    }
  }

  model::Model model;
  std::vector<Box> swept;
};

/// One iteration finds the islands once.
void graph(benchmark::State& state, Packing packing) {
  const Boxes boxes(packing, static_cast<Index>(state.range(0)));
  std::vector<Island> islands;
  const std::clock_t start = std::clock();
  fexp::parallel::with_threads(static_cast<int>(state.range(1)), [&] {
    for (auto iteration : state) {
      islands = find_islands(boxes.model, boxes.swept);
    }
  });
  state.counters["bodies"] = static_cast<double>(boxes.swept.size());
  state.counters["islands"] = static_cast<double>(islands.size());
  state.counters["cpu_milliseconds"] = milliseconds_since(start, state);
  state.counters["resident_megabytes"] = 1.0e-6 * fexp::bench::most_resident_bytes();
}

std::vector<Island> islands_of(const std::vector<std::vector<Index>>& lists) {
  std::vector<Island> islands;
  for (const std::vector<Index>& bodies : lists) {
    islands.push_back({bodies, {}});
  }
  std::sort(islands.begin(), islands.end(),
            [](const Island& a, const Island& b) { return a.bodies.front() < b.bodies.front(); });
  return islands;
}

/// Islands of one to eight bodies, and the same where every tenth has merged with the next and every tenth has split.
struct Epochs {
  explicit Epochs(Index count) {
    std::mt19937_64 random(2);
    std::vector<std::vector<Index>> lists;
    for (Index body = 0; body < count;) {
      const Index size = std::min<Index>(1 + static_cast<Index>(random() % 8), count - body);
      std::vector<Index>& list = lists.emplace_back();
      for (Index k = 0; k < size; ++k) {
        list.push_back(body++);
      }
    }
    first = islands_of(lists);
    std::vector<std::vector<Index>> later;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      const std::vector<Index>& list = lists[i];
      if (i % 10 == 0 && i + 1 < lists.size()) {
        std::vector<Index>& merged = later.emplace_back(list);
        merged.insert(merged.end(), lists[i + 1].begin(), lists[i + 1].end());
        ++i;
      } else if (i % 10 == 5 && list.size() > 1) {
        const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
        later.emplace_back(list.begin(), middle);
        later.emplace_back(middle, list.end());
      } else {
        later.push_back(list);
      }
    }
    second = islands_of(later);
  }

  std::vector<Island> first;
  std::vector<Island> second;
};

/// Load of the busiest machine over the mean, less 1.
double imbalance(const std::vector<MachineIndex>& owner, std::size_t machines) {
  std::vector<double> load(machines, 0.0);
  for (const MachineIndex machine : owner) {
    load[static_cast<std::size_t>(machine)] += 1.0;
  }
  return *std::max_element(load.begin(), load.end()) * static_cast<double>(machines) /
             static_cast<double>(owner.size()) -
         1.0;
}

/// One iteration places the islands of the second epoch.
void place(benchmark::State& state, PlacementRule rule) {
  const auto bodies = static_cast<Index>(state.range(0));
  const auto machine_count = static_cast<std::size_t>(state.range(1));
  const Epochs epochs(bodies);
  const std::vector<double> weight(at(bodies), body_elements);
  std::vector<Machine> machines(machine_count);
  for (std::size_t m = 0; m < machine_count; ++m) {
    machines[m].rank = static_cast<int>(m);
  }
  const std::vector<MachineIndex> nowhere(at(bodies), no_machine);
  const Placement start = place_islands({rule, epochs.first, {}, nowhere, weight, machines});
  Placement next;
  const std::clock_t clock = std::clock();
  for (auto iteration : state) {
    next = place_islands({rule, epochs.second, epochs.first, start.owner, weight, machines});
  }
  const double milliseconds = milliseconds_since(clock, state);
  const double moved = static_cast<double>(next.moves.size());
  state.counters["bodies"] = bodies;
  state.counters["machines"] = static_cast<double>(machine_count);
  state.counters["cpu_milliseconds"] = milliseconds;
  state.counters["resident_megabytes"] = 1.0e-6 * fexp::bench::most_resident_bytes();
  state.counters["imbalance_at_start"] = imbalance(start.owner, machine_count);
  state.counters["imbalance"] = imbalance(next.owner, machine_count);
  state.counters["moved_bodies"] = moved;
  state.counters["moved_megabytes"] = 1.0e-6 * moved * body_bytes;
  // What a rank gets at every epoch's end: notices of all bodies, costs of all islands, records of all ranks.
  state.counters["notice_megabytes"] = 1.0e-6 * (static_cast<double>(bodies) * sizeof(BodyNotice) +
                                                 static_cast<double>(epochs.second.size()) * sizeof(double) +
                                                 static_cast<double>(machine_count) * sizeof(RankRecord));
}

void graph_sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"bodies", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  b->ArgsProduct({{10'000, 100'000, 1'000'000}, {1, 2}});
}

void place_sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"bodies", "machines"})->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(1);
  b->ArgsProduct({{10'000, 100'000, 1'000'000}, {100, 1000, 10'000}});
}

}  // namespace

BENCHMARK_CAPTURE(graph, pairs, Packing::pairs)->Apply(graph_sizes);
BENCHMARK_CAPTURE(graph, dense, Packing::dense)->Apply(graph_sizes);
BENCHMARK_CAPTURE(place, elements, PlacementRule::fewest_elements)->Apply(place_sizes);
BENCHMARK_CAPTURE(place, cost, PlacementRule::measured_cost)->Apply(place_sizes);
BENCHMARK_MAIN();
