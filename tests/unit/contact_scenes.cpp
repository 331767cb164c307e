// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>

#include "cluster/simulation.hpp"
#include "parallel/parallel.hpp"
#include "support/contact.hpp"

/// Random scenes of several bodies that collide: what has to hold whatever happens in them.
namespace fexp {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)};
      if (norm(v) > 0.1 && norm(v) < 1.0) {
        return (1.0 / norm(v)) * v;
      }
    }
  }

 private:
  std::mt19937 random_;
};

/// A mesh of about the size of 1 with `cells` cells along it.
model::MeshGenerator random_mesh(Dice& dice, int cells) {
  switch (dice.whole(0, 4)) {
    case 0:
      return model::CubedSphere{0.5, std::max(2, cells / 2)};
    case 1:
      return test::plate(1.0, 0.7, cells, cells, dice.whole(0, 1) == 0 ? "one" : "crossed");
    case 2:
      return model::Cylinder{0.4, 0.9, std::max(6, 2 * cells), cells, 360.0};
    case 3:
      return model::SquareTube{0.6, 0.9, std::max(2, cells / 2), cells};
    default:
      return model::OpenBox{0.8, 0.7, 0.6, cells, cells, std::max(2, cells / 2)};
  }
}

/// Bodies of unlike mesh size (up to 20:1), thickness, material and kind that fly into each other at up to a tenth of
/// the speed of sound, half of the scenes with a fixed plate among them.
model::Description random_scene(unsigned seed) {
  Dice dice(seed);
  auto d = test::description({1000.0, 1.0e6, 0.3}, 0.01);
  d.contact.enabled = true;
  d.run.energy_drift_limit = 1.0e9;
  const int count = dice.whole(2, 5);
  for (int i = 0; i < count; ++i) {
    const std::string name = "body " + std::to_string(i);
    const int cells = std::array{2, 3, 4, 8, 16}[static_cast<std::size_t>(dice.whole(0, i == 0 ? 4 : 3))];
    d.materials.push_back(
        {name, physics::LinearElastic{1000.0 * dice.number(0.3, 3.0), 1.0e6 * dice.number(0.3, 3.0), 0.3}, {}});
    d.sections.push_back({name, name, std::pow(10.0, dice.number(-2.3, -0.9)), {}});
    model::BodyDescription& body = test::add_body(d, name, random_mesh(dice, cells));
    body.section = name;
    body.rotate.push_back({dice.direction(), dice.number(0.0, 180.0), {}});
    body.translate = 1.9 * Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)};
    const Vec3d middle{0.95, 0.95, 0.2};
    const double sound = 33.0;
    body.velocity = (0.1 * sound * dice.number(0.3, 1.0)) * (middle - body.translate);
    body.velocity = (std::min(1.0, 0.1 * sound / norm(body.velocity))) * body.velocity;
    const Vec3d axis = dice.direction();  // In an order that is no compiler's choice
    body.angular_velocity = dice.number(0.0, 1.0) * axis;
  }
  if (seed % 2 == 1) {
    test::add_body(d, "wall", test::plate(6.0, 6.0, 5, 5)).translate = {-2.0, -2.0, -1.3};
    test::add_box_set(d, "wall", {-9.0, -9.0, -1.31}, {9.0, 9.0, -1.29});
    d.node_sets.back().bodies = {"wall"};
    test::fix(d, "wall", {"x", "y", "z", "rx", "ry", "rz"});
    d.gravity.push_back({{0.0, 0.0, -5.0}, "", {}});
  }
  return d;
}

struct Outcome {
  std::uint64_t hash{};
  double energy_error{}, linear_error{}, angular_error{};
  Index most_pairs{};
  Index steps{};
  double searches_a_step{};
  cluster::FaultKind fault{};
  std::string message;
};

Outcome run(const model::Model& model, double duration, int threads) {
  Outcome outcome;
  parallel::with_threads(threads, [&] {
    cluster::Simulation simulation(model, solve::KernelChoice::automatic);
    while (simulation.state().time < duration && outcome.fault == cluster::FaultKind::none) {
      const cluster::EpochReport report = simulation.run_epoch(duration);
      outcome.fault = report.fault.kind;
      outcome.message = report.fault.message;
      outcome.steps += report.steps;
    }
    const cluster::RunExtremes& x = simulation.extremes();
    outcome.hash = model::state_hash(model, simulation.state());
    outcome.energy_error = x.energy_error;
    outcome.linear_error = x.linear_momentum_error;
    outcome.angular_error = x.angular_momentum_error;
    outcome.most_pairs = x.most_active_pairs;
    outcome.searches_a_step = static_cast<double>(x.searches) / outcome.steps;
  });
  return outcome;
}

/// Seeds [first, last]; FEXP_SCENES=FIRST-LAST in the environment makes a longer hunt. In the usual ones no node is
/// driven deeper than a pair is kept for: where one is, the energy of the pair is lost with it. Decision 0028 has what
/// the others do.
std::array<unsigned, 2> seeds() {
  std::array<unsigned, 2> range{29, 79};
  if (const char* given = std::getenv("FEXP_SCENES")) {
    std::istringstream text(given);
    char dash = 0;
    text >> range[0] >> dash >> range[1];
  }
  return range;
}

TEST(contact_scenes, keep_energy_and_momentum_and_stay_finite_whatever_collides) {
  Index most_pairs = 0;
  const auto [first, last] = seeds();
  for (unsigned seed = first; seed <= last; ++seed) {
    const model::Model model = test::build(random_scene(seed));
    const Outcome outcome = run(model, 0.5, 2);
    std::printf(
        "seed %u: %d bodies, %d elements, %d steps, %d pairs, energy %.1e, momentum %.1e %.1e, %.2f searches a step\n",
        seed, model.body_count(), model.element_count(), outcome.steps, outcome.most_pairs, outcome.energy_error,
        outcome.linear_error, outcome.angular_error, outcome.searches_a_step);
    EXPECT_EQ(outcome.fault, cluster::FaultKind::none) << "seed " << seed << ": " << outcome.message;
    EXPECT_LE(outcome.energy_error, 0.01) << "seed " << seed;
    EXPECT_LE(outcome.linear_error, 1e-12) << "seed " << seed;
    EXPECT_LE(outcome.angular_error, 1e-12) << "seed " << seed;
    EXPECT_LE(outcome.searches_a_step, 2.0) << "seed " << seed;
    most_pairs = std::max(most_pairs, outcome.most_pairs);
  }
  EXPECT_GT(most_pairs, 20);
}

TEST(contact_scenes, are_the_same_with_one_thread_and_four) {
  for (const unsigned seed : {3U, 8U, 13U}) {
    const model::Model model = test::build(random_scene(seed));
    EXPECT_EQ(run(model, 0.3, 1).hash, run(model, 0.3, 4).hash) << "seed " << seed;
  }
}

}  // namespace
}  // namespace fexp
