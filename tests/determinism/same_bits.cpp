// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "determinism/scenes.hpp"
#include "parallel/parallel.hpp"

namespace fexp {
namespace {

using solve::KernelChoice;

#ifdef FEXP_THREAD_SANITIZER
// The sanitizer looks for races between threads, which four of them show as well, and takes thirty times as long.
constexpr std::array thread_counts{4};
constexpr std::array<KernelChoice, 0> kernels{};
#else
constexpr std::array thread_counts{1, 2, 3, 4, 8};
constexpr std::array kernels{KernelChoice::baseline, KernelChoice::avx2, KernelChoice::avx512};
#endif

struct Scene {
  std::string name;
  model::Description (*describe)();
  double duration{};
  /// That the run had in it what the scene is there for.
  std::function<bool(const test::Outcome&)> worth;
};

std::ostream& operator<<(std::ostream& out, const Scene& scene) { return out << scene.name; }

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{
      {"two_pairs_of_spheres", test::two_pairs_of_spheres, 0.2,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 20 && o.extremes.most_islands == 4; }},
      {"sphere_on_plate", test::sphere_on_plate, 0.05,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.extremes.rollbacks > 0; }},
      {"tube_that_folds", test::tube_that_folds, 0.06,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.own_sides > 0; }},
      {"plates_at_rest", test::plates_at_rest, 0.05,
       [](const test::Outcome& o) { return o.extremes.fewest_islands == 3 && o.extremes.most_active_pairs > 5; }},
      {"plates_that_stop", test::plates_that_stop, 0.4,
       [](const test::Outcome& o) { return o.stops > 3 && o.extremes.most_active_pairs > 5; }},
      {"metals", test::metals, 0.06,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.plastic_strain > 0.1; }},
      {"hot_metals", test::hot_metals, 0.06,
       [](const test::Outcome& o) {
         return o.extremes.most_active_pairs > 5 && o.plastic_strain > 0.1 && o.temperature > 5.0;
       }},
      {"shot", test::shot, 0.04,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.deleted > 9; }},
      {"damped_shot", test::damped_shot, 0.04,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.deleted > 9 && o.damping > 0.0; }},
      {"rigid_and_soft", test::rigid_and_soft, 0.12,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 5 && o.extremes.energy_error < 0.01; }},
      {"tied_panel", test::tied_panel, 0.1,
       [](const test::Outcome& o) {
         return o.extremes.most_active_pairs > 5 && o.extremes.energy_error < 0.01 && o.extremes.most_islands <= 2;
       }},
      {"torn_panel", test::torn_panel, 0.1,
       [](const test::Outcome& o) {
         return o.extremes.most_active_pairs > 5 && o.extremes.energy_error < 0.01 && o.broken > 60 && o.broken < 130 &&
                o.extremes.most_islands > o.extremes.fewest_islands;
       }},
      {"rigid_machine", test::rigid_machine, 0.1,
       [](const test::Outcome& o) { return o.extremes.most_active_pairs > 20; }},
      {"walls_with_mass", test::walls_with_mass, 0.12,
       [](const test::Outcome& o) {
         return o.extremes.most_active_pairs > 0 && o.extremes.most_islands > o.extremes.fewest_islands;
       }},
      {"swarm", test::swarm, 0.1,
       [](const test::Outcome& o) {
         return o.extremes.most_active_pairs > 20 && o.extremes.most_islands > o.extremes.fewest_islands;
       }},
  };
  return all;
}

class same_bits : public testing::TestWithParam<Scene> {
 protected:
  void expect_same(const test::Outcome& outcome, const test::Outcome& reference) {
    EXPECT_EQ(outcome.state_hash, reference.state_hash);
    ASSERT_EQ(outcome.hashes.size(), reference.hashes.size());
    for (std::size_t i = 0; i < outcome.hashes.size(); ++i) {
      const solve::HashRecord &a = outcome.hashes[i], &b = reference.hashes[i];
      ASSERT_EQ(a.step, b.step);
      ASSERT_EQ(a.body, b.body);
      ASSERT_EQ(a.hash, b.hash) << "body " << a.body << " after step " << a.step;
    }
    EXPECT_EQ(outcome.extremes.energy_error, reference.extremes.energy_error);
    EXPECT_EQ(outcome.extremes.linear_momentum_error, reference.extremes.linear_momentum_error);
    EXPECT_EQ(outcome.extremes.angular_momentum_error, reference.extremes.angular_momentum_error);
    EXPECT_EQ(outcome.extremes.rollbacks, reference.extremes.rollbacks);
  }
};

TEST_P(same_bits, for_any_number_of_threads_and_any_kernel) {
  const model::Model model = test::build(GetParam().describe());
  test::Outcome reference;
  parallel::with_threads(1, [&] { reference = test::run_scene(model, GetParam().duration, KernelChoice::scalar); });
  const cluster::RunExtremes& x = reference.extremes;
  std::printf(
      "%ld epochs, %ld rolled back, %d to %d islands, %d pairs, %zu own sides, %ld broken ties, energy error %.1e\n",
      static_cast<long>(x.epochs), static_cast<long>(x.rollbacks), x.fewest_islands, x.most_islands,
      x.most_active_pairs, reference.own_sides, static_cast<long>(reference.broken), x.energy_error);
  ASSERT_TRUE(GetParam().worth(reference));
  for (const int threads : thread_counts) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    parallel::with_threads(
        threads, [&] { expect_same(test::run_scene(model, GetParam().duration, KernelChoice::automatic), reference); });
  }
  for (const KernelChoice kernel : kernels) {
    const solve::SelectedKernel selected = solve::select_element_kernel(kernel);
    SCOPED_TRACE(selected.name);
    if (selected.elements != nullptr) {
      parallel::with_threads(2, [&] { expect_same(test::run_scene(model, GetParam().duration, kernel), reference); });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(scenes, same_bits, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param.name; });

/// One island of all bodies, stepped without a guard and taken up anew whenever the test asks for it.
class Island {
 public:
  explicit Island(const model::Model& model)
      : model_(model),
        state_(model::initial_state(model)),
        workspace_(model, solve::select_element_kernel(KernelChoice::automatic)),
        allowance_(model.bodies.size(), HUGE_VAL) {
    take_up();
  }

  void advance(double dt, Index steps) {
    std::vector<solve::HashRecord> hashes;
    const double end = state_.time + static_cast<double>(steps) * dt;
    const auto report =
        solver_.advance(model_, state_, workspace_, {dt, steps, end, 0, allowance_, model_.run.damping}, hashes);
    ASSERT_EQ(report.steps_done, steps);
    most_pairs_ = std::max(most_pairs_, report.most_active_pairs);
    solver_.store(model_, state_);
    state_.step += steps;
    state_.time = end;
  }

  /// Goes on from nothing but the bytes of the state, as after a crash or on another machine.
  void move() {
    model::State state = model::initial_state(model_);
    state.step = state_.step;
    state.time = state_.time;
    for (Index b = 0; b < model_.body_count(); ++b) {
      std::vector<std::byte> bytes;
      model::append_body_bytes(model_, state_, b, bytes);
      ASSERT_TRUE(model::read_body_bytes(model_, bytes, b, state));
    }
    state_ = state;
    workspace_ = solve::Workspace(model_, workspace_.kernel);
    take_up();
  }

  [[nodiscard]] std::uint64_t hash() const { return model::state_hash(model_, state_); }
  [[nodiscard]] Index most_pairs() const noexcept { return most_pairs_; }

 private:
  void take_up() {
    solver_ = {};
    std::vector<Index> bodies;
    for (Index b = 0; b < model_.body_count(); ++b) {
      bodies.push_back(b);
    }
    solver_.assign(model_, workspace_.patches, state_, bodies, {});
    solver_.evaluate(model_, state_, workspace_);
  }

  const model::Model& model_;
  model::State state_;
  solve::Workspace workspace_;
  std::vector<double> allowance_;
  solve::IslandSolver solver_;
  Index most_pairs_{};
};

/// A step that is a power of two, so that times are the same however steps are cut into epochs.
double round_step(const model::Model& model) {
  return std::exp2(std::floor(std::log2(0.6 * model.first_critical_step)));
}

TEST_P(same_bits, however_steps_are_cut_into_epochs) {
  const model::Model model = test::build(GetParam().describe());
  const double dt = round_step(model);
  const auto steps = static_cast<Index>(GetParam().duration / dt);
  Island whole(model);
  whole.advance(dt, steps);
  EXPECT_GT(whole.most_pairs(), 0);
  for (const Index length : {1, 7, 64}) {
    Island cut(model);
    for (Index done = 0; done < steps; done += length) {
      cut.advance(dt, std::min(length, steps - done));
    }
    EXPECT_EQ(cut.hash(), whole.hash()) << "epochs of " << length;
  }
}

TEST_P(same_bits, when_an_island_goes_on_from_its_bytes_alone) {
  const model::Model model = test::build(GetParam().describe());
  const double dt = round_step(model);
  const auto steps = static_cast<Index>(GetParam().duration / dt);
  Island staying(model), moving(model);
  for (Index done = 0; done < steps; done += 10) {
    staying.advance(dt, 10);
    moving.advance(dt, 10);
    ASSERT_EQ(moving.hash(), staying.hash()) << "after step " << done + 10;
    moving.move();
    ASSERT_EQ(moving.hash(), staying.hash()) << "taken up after step " << done + 10;
  }
  EXPECT_GT(moving.most_pairs(), 0);
}

/// Epochs that are rolled back during contact, as the load sets in.
TEST(roll_back, in_contact_ends_in_the_state_of_an_epoch_planned_shorter_from_the_start) {
  model::Description d = test::two_pairs_of_spheres();
  for (model::BodyDescription& body : d.bodies) {
    body.translate.x *= 0.65;
    body.velocity = {};
  }
  d.curves.push_back({"jolt", {{0.02, 0.0}, {0.021, 1.0}}, {}});
  for (int i = 0; i < 4; ++i) {
    const std::string name = "set " + std::to_string(i);
    model::NodeSet set;
    set.name = name;
    set.bodies = {d.bodies[static_cast<std::size_t>(i)].name};
    d.node_sets.push_back(set);
    d.forces.push_back({name, {i % 2 == 0 ? 4.0e5 : -4.0e5, 0.0, 0.0}, {}, true, "jolt", {}});
  }
  d.run.energy_drift_limit = 1.0;
  d.contact.hardening = 0.0;  // Deep contact that hardens makes the step smaller before two epochs are compared
  model::Model model = test::build(d);
  model::Model other = model;
  cluster::Simulation one(model, KernelChoice::automatic), two(other, KernelChoice::automatic);
  int compared = 0;
  for (int i = 0; i < 40 && compared < 2; ++i) {
    const cluster::EpochReport first = one.run_epoch(1.0);
    ASSERT_EQ(first.fault.kind, cluster::FaultKind::none) << first.fault.message;
    other.run.epoch_steps = first.steps;
    const cluster::EpochReport second = two.run_epoch(1.0);
    other.run.epoch_steps = model.run.epoch_steps;
    if (first.dt != second.dt) {
      break;  // The guard had it redone with a smaller step; from there on the runs differ.
    }
    ASSERT_EQ(model::state_hash(model, one.state()), model::state_hash(other, two.state())) << "epoch " << i;
    compared += first.rollbacks > 0 && second.rollbacks == 0 && first.active_pairs > 0 ? 1 : 0;
  }
  EXPECT_EQ(compared, 2);
}

}  // namespace
}  // namespace fexp
