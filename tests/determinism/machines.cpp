// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "cluster/shipment.hpp"
#include "determinism/scenes.hpp"
#include "support/thread_world.hpp"

/// The same bits on any number of machines, wherever bodies move, and whenever machines come and go.
namespace fexp {
namespace {

using solve::KernelChoice;

struct Scene {
  std::string name;
  model::Description (*describe)();
  double duration{};
};

std::ostream& operator<<(std::ostream& out, const Scene& scene) { return out << scene.name; }

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{{"two_pairs_of_spheres", test::two_pairs_of_spheres, 0.2},
                                      {"sphere_on_plate", test::sphere_on_plate, 0.05},
                                      {"tube_that_folds", test::tube_that_folds, 0.04},
                                      {"plates_at_rest", test::plates_at_rest, 0.05},
                                      {"plates_that_stop", test::plates_that_stop, 0.4},
                                      {"metals", test::metals, 0.06},
                                      {"hot_metals", test::hot_metals, 0.06},
                                      {"shot", test::shot, 0.06},
                                      {"damped_shot", test::damped_shot, 0.06},
                                      {"rigid_and_soft", test::rigid_and_soft, 0.12},
                                      {"tied_panel", test::tied_panel, 0.1},
                                      {"torn_panel", test::torn_panel, 0.1},
                                      {"rigid_machine", test::rigid_machine, 0.1},
                                      {"walls_with_mass", test::walls_with_mass, 0.12},
                                      {"swarm", test::swarm, 0.1}};
  return all;
}

#ifdef FEXP_THREAD_SANITIZER
// It looks for races between ranks that share the model, which three of them show as well.
const std::vector<int> counts{3};
constexpr unsigned seeds = 2;
#else
const std::vector<int> counts{2, 3, 5};
constexpr unsigned seeds = 6;
#endif

std::vector<std::string> names(int count) {
  std::vector<std::string> list;
  for (int i = 0; i < count; ++i) {
    list.push_back("c" + std::to_string(i + 1));
  }
  return list;
}

/// What a run on several machines came to, as rank 0 has it.
struct Result {
  std::uint64_t state_hash{};
  cluster::RunExtremes extremes;
  std::vector<solve::HashRecord> hashes;
  std::int64_t moved_elements{};
  std::vector<cluster::EpochReport> reports;
};

void note_end(cluster::Simulation& simulation, Result& result) {
  simulation.collect();
  if (simulation.rank() == 0) {
    result.state_hash = model::state_hash(simulation.model(), simulation.state());
    result.extremes = simulation.extremes();
    result.moved_elements = simulation.ledger().moved_elements();
  }
}

void expect_same(const Result& result, const test::Outcome& reference) {
  EXPECT_EQ(result.state_hash, reference.state_hash);
  EXPECT_EQ(result.extremes.energy_error, reference.extremes.energy_error);
  EXPECT_EQ(result.extremes.linear_momentum_error, reference.extremes.linear_momentum_error);
  EXPECT_EQ(result.extremes.angular_momentum_error, reference.extremes.angular_momentum_error);
  EXPECT_EQ(result.extremes.rollbacks, reference.extremes.rollbacks);
  EXPECT_EQ(result.extremes.most_active_pairs, reference.extremes.most_active_pairs);
  EXPECT_EQ(result.extremes.deepest, reference.extremes.deepest);
  EXPECT_EQ(result.extremes.most_islands, reference.extremes.most_islands);
}

class machines : public testing::TestWithParam<Scene> {};

TEST_P(machines, any_number_of_them_gives_the_same_bits) {
  const model::Model model = test::build(GetParam().describe());
  test::Outcome reference;
  parallel::with_threads(1, [&] { reference = test::run_scene(model, GetParam().duration, KernelChoice::automatic); });
  for (const auto rule : {cluster::PlacementRule::fewest_elements, cluster::PlacementRule::measured_cost}) {
    for (const int count : counts) {
      SCOPED_TRACE(std::to_string(count) + " machines");
      Result result;
      test::with_world(
          names(count),
          [&](cluster::World world) {
            cluster::Simulation simulation(model, KernelChoice::automatic, std::move(world));
            while (simulation.state().time < GetParam().duration) {
              const cluster::EpochReport report = simulation.run_epoch(GetParam().duration, 16);
              ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
              if (simulation.rank() == 0) {
                result.hashes.insert(result.hashes.end(), report.hashes.begin(), report.hashes.end());
              }
            }
            note_end(simulation, result);
          },
          1, rule);
      expect_same(result, reference);
      ASSERT_EQ(result.hashes.size(), reference.hashes.size());
      for (std::size_t i = 0; i < result.hashes.size(); ++i) {
        ASSERT_EQ(result.hashes[i].hash, reference.hashes[i].hash)
            << "body " << reference.hashes[i].body << " after step " << reference.hashes[i].step;
      }
    }
  }
}

/// Worlds follow each other. Each makes a few epochs, leaves a piece of the state for each machine and one for its
/// buddy, and ends; then some machines are lost with all that they hold, and others come.
TEST_P(machines, may_come_and_go) {
  model::Description description = GetParam().describe();
  description.run.epoch_steps = 4;
  const model::Model model = test::build(description);
  test::Outcome reference;
  parallel::with_threads(1, [&] { reference = test::run_scene(model, GetParam().duration, KernelChoice::automatic); });
  for (unsigned seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<std::string> present = names(1 + static_cast<int>(random() % 4));
    std::vector<std::vector<Bytes>> held;  // [machines of the world before][pieces]
    std::vector<std::string> held_by;
    Result result;
    int worlds = 0;
    for (bool over = false; !over; ++worlds) {
      const int epochs = 1 + static_cast<int>(random() % 7);
      std::vector<std::vector<Bytes>> next_held(present.size());
      test::with_world(present, [&](cluster::World world) {
        const auto rank = static_cast<std::size_t>(world.communicator->rank());
        std::vector<Bytes> pieces;
        const auto found = std::ranges::find(held_by, present[rank]);
        if (found != held_by.end()) {
          pieces = held[static_cast<std::size_t>(found - held_by.begin())];
        }
        auto simulation = held_by.empty()
                              ? std::make_unique<cluster::Simulation>(model, KernelChoice::automatic, std::move(world))
                              : std::make_unique<cluster::Simulation>(model, KernelChoice::automatic, std::move(world),
                                                                      std::span<const Bytes>(pieces));
        for (int e = 0; e < epochs && simulation->state().time < GetParam().duration; ++e) {
          const cluster::EpochReport report = simulation->run_epoch(GetParam().duration);
          ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
        }
        const Bytes own = simulation->piece(simulation->own_bodies());
        const std::vector<Bytes> all = simulation->world().communicator->all_gather(own);
        next_held[rank] = {own, all[(rank + 1) % all.size()]};
        if (simulation->state().time >= GetParam().duration) {
          note_end(*simulation, result);
          if (rank == 0) {
            over = true;
          }
        }
      });
      held = std::move(next_held);
      held_by = present;
      // At most one machine is lost, so that its buddy still has what it held.
      if (present.size() > 1 && random() % 2 == 0) {
        present.erase(present.begin() + static_cast<std::ptrdiff_t>(random() % present.size()));
      }
      for (int i = 0; i < 6; ++i) {
        const std::string name = "c" + std::to_string(i + 1);
        if (random() % 4 == 0 && std::ranges::find(present, name) == present.end()) {
          present.push_back(name);
        }
      }
    }
    EXPECT_GT(worlds, 2);
    expect_same(result, reference);
  }
}

INSTANTIATE_TEST_SUITE_P(scenes, machines, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param.name; });

TEST(machines, that_hold_no_piece_or_pieces_of_another_model_are_told) {
  const model::Model model = test::build(test::two_pairs_of_spheres());
  const model::Model other = test::build(test::swarm());
  cluster::Simulation simulation(model, KernelChoice::automatic);
  const std::vector<Bytes> whole{simulation.piece(simulation.own_bodies())};
  const std::vector<Bytes> part{simulation.piece(std::vector<Index>{0, 1, 2})};
  const auto take_up = [](const model::Model& m, std::span<const Bytes> pieces) {
    const cluster::Simulation taken(m, KernelChoice::automatic, cluster::World::alone(), pieces);
  };
  EXPECT_NO_THROW(take_up(model, whole));
  EXPECT_THROW(take_up(model, part), cluster::ShipmentError);
  EXPECT_THROW(take_up(model, {}), cluster::ShipmentError);
  EXPECT_THROW(take_up(other, whole), cluster::ShipmentError);
  std::vector<Bytes> damaged = whole;
  damaged[0][damaged[0].size() / 2] ^= std::byte{1};
  EXPECT_THROW(take_up(model, damaged), cluster::ShipmentError);
}

}  // namespace
}  // namespace fexp
