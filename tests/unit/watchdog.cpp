// SPDX-License-Identifier: Apache-2.0
#include "cluster/watchdog.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "cluster/simulation.hpp"
#include "contact/pair_books.hpp"
#include "support/contact.hpp"
#include "support/models.hpp"

namespace fexp::cluster {
namespace {

using test::plate;
using test::rubber;
constexpr double never = 1.0e9;  // a target that no epoch reaches

model::CubedSphere sphere(double radius, int cells) {
  model::CubedSphere s;
  s.radius = radius;
  s.cells = cells;
  return s;
}

/// Two balls fall on a plate each, the second ten times as fast, and a plate of which nothing comes flies by.
model::Description two_falls(double slow, double fast) {
  auto d = test::description(rubber, 0.01);
  d.contact.enabled = true;
  for (const auto& [name, x, speed] : {std::tuple{"slow", 0.0, slow}, std::tuple{"fast", 5.0, fast}}) {
    const std::string ball = std::string(name) + " ball", below = std::string(name) + " plate";
    model::BodyDescription& body = test::add_body(d, ball, sphere(0.1, 4));
    body.translate = {x, 0.0, 0.115};
    body.velocity = {0.1, 0.2, -speed};
    test::add_body(d, below, plate(0.4, 0.4, 8, 8)).translate = {x - 0.2, -0.2, 0.0};
  }
  test::add_body(d, "calm", plate(1.0, 1.0, 3, 3)).translate = {10.0, 0.0, 0.0};
  d.bodies.back().velocity = {0.0, 0.0, 1.0};
  return d;
}

/// The index of a body by its name.
Index body_of(const model::Model& model, const std::string& name) {
  for (Index b = 0; b < model.body_count(); ++b) {
    if (model.bodies[at(b)].name == name) {
      return b;
    }
  }
  ADD_FAILURE() << "no body " << name;
  return no_index;
}

EpochReport run(Simulation& simulation, double until, const std::function<void(const EpochReport&)>& after = {}) {
  EpochReport report;
  while (simulation.state().time < until && report.fault.kind == FaultKind::none) {
    report = simulation.run_epoch(until);
    if (after) {
      after(report);
    }
  }
  return report;
}

TEST(watchdog, what_the_model_is_off_is_the_sum_of_what_its_bodies_and_pairs_are) {
  for (const bool friction : {false, true}) {
    auto d = two_falls(1.0, 4.0);
    d.contact.friction = friction ? 0.3 : 0.0;
    d.contact.damping = friction ? 0.1 : 0.0;
    d.run.damping = 2.0;
    d.gravity.push_back({{0.0, 0.0, -9.81}, "", {}});
    d.planes.push_back({{"floor"}, {0.0, 0.0, -0.05}, {0.0, 0.0, 1.0}});
    d.run.energy_drift_limit = 1.0;
    const model::Model model = test::build(d);
    Simulation simulation(model, solve::KernelChoice::automatic);
    double open = 0.0, scale = 0.0;
    solve::Diagnostics before = simulation.start();
    int touched = 0;
    run(simulation, 0.06, [&](const EpochReport& report) {
      const solve::Diagnostics& is = report.diagnostics;
      open += is.energies.balance() - before.energies.balance() -
              0.125 * report.dt * report.dt * (is.acceleration_square - before.acceleration_square);
      before = is;
      scale = std::max(scale, is.energies.kinetic);
      double sum = 0.0, work = 0.0, booked = 0.0;
      for (Index b = 0; b < model.body_count(); ++b) {
        sum += simulation.watchdog().off()[at(b)];
        work += simulation.state().ledger[at(b)].contact_work;
        for (const model::PairBook& book : simulation.state().pair_books[at(b)]) {
          sum += book.open();
          booked += book.work + book.work_other;
        }
      }
      EXPECT_NEAR(sum, open, 1.0e-11 * scale);
      EXPECT_NEAR(work, booked, 1.0e-12 * scale);
      touched += report.active_pairs > 0 ? 1 : 0;
    });
    EXPECT_GT(touched, 1);
    EXPECT_GT(std::abs(open), 1.0e-9 * scale) << "nothing was off that could be told apart";
  }
}

TEST(watchdog, a_pair_keeps_one_book_and_none_without_contact) {
  const model::Model model = test::build(two_falls(0.0, 4.0));
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.03);
  EXPECT_EQ(report.fault.kind, FaultKind::none) << report.fault.message;
  const Index ball = body_of(model, "fast ball"), below = body_of(model, "fast plate");
  for (Index b = 0; b < model.body_count(); ++b) {
    for (const model::PairBook& book : simulation.state().pair_books[at(b)]) {
      EXPECT_EQ(b, ball);
      EXPECT_TRUE(book.other == below || book.other == ball);
    }
  }
  ASSERT_FALSE(simulation.state().pair_books[at(ball)].empty());
  const model::PairBook& book = simulation.state().pair_books[at(ball)].back();
  EXPECT_EQ(book.other, below);
  EXPECT_LT(book.work, 0.0) << "the plate takes energy of the ball";
  EXPECT_GT(book.work_other, 0.0);
  EXPECT_LT(std::abs(book.open()), 0.02 * book.work_other);
  EXPECT_EQ(simulation.extremes().retries, 0);
}

TEST(pair_books, what_two_bodies_have_in_store_before_any_step_is_not_off_and_the_lower_keeps_the_books) {
  model::Model model = test::build(two_falls(0.0, 0.0));
  model::State state = model::initial_state(model);
  const std::vector<Index> bodies{0, 1, 2, 3, 4};
  contact::PairBooks books;
  books.assign(state, bodies);
  books.open(true);
  books.add(model, 3, 1, 2.0, 0.0);
  books.add(model, 1, 3, 0.5, 0.0);
  books.close();
  books.open(false);
  books.add(model, 3, 1, 1.0, 0.25);
  books.add(model, 2, 2, 4.0, 0.0);
  books.add(model, 4, 0, 0.0, 0.0);
  books.close();
  books.add_work(model, 3, 1, 0.75, -0.5);
  books.store(bodies, state);
  const model::PairBook pair{3, 2.5, 1.0, 0.25, -0.5, 0.75}, own{2, 0.0, 4.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(state.pair_books[1], std::vector{pair});
  EXPECT_EQ(pair.open(), -1.0);
  EXPECT_EQ(state.pair_books[2], std::vector{own}) << "touched in a step, so it began with nothing";
  for (const std::size_t b : {0U, 3U, 4U}) {
    EXPECT_TRUE(state.pair_books[b].empty());
  }
  // Taken up again, a potential without a step is not a new beginning.
  contact::PairBooks again;
  again.assign(state, bodies);
  again.open(true);
  again.add(model, 1, 3, 1.0, 0.0);
  again.close();
  again.store(bodies, state);
  EXPECT_EQ(state.pair_books[1], std::vector{pair});
  // A barrier keeps no books.
  model.bodies[0].barrier = true;
  again.add(model, 0, 4, 1.0, 0.0);
  again.store(bodies, state);
  EXPECT_EQ(state.pair_books[4].front().other, 0);
}

TEST(watchdog, rows_are_those_of_the_last_epochs_and_one_can_be_taken_back) {
  Watchdog dog(2);
  std::vector<BodyNotice> before(2), after(2);
  EXPECT_TRUE(dog.epochs().empty());
  EXPECT_TRUE(dog.rows(1).empty());
  for (int e = 1; e <= 20; ++e) {
    after[1].diagnostics.energies.kinetic = before[1].diagnostics.energies.kinetic + 1.0;
    after[1].contact_work = before[1].contact_work + 0.25;
    dog.add({e, 0.1 * e, 0.1, 0.0}, before, after);
    before = after;
  }
  ASSERT_EQ(dog.epochs().size(), static_cast<std::size_t>(Watchdog::most_rows));
  EXPECT_EQ(dog.epochs().front().step, 20 - Watchdog::most_rows + 1);
  EXPECT_EQ(dog.rows(1).back().kinetic, 20.0);
  EXPECT_EQ(dog.off()[0], 0.0);
  EXPECT_EQ(dog.off()[1], 15.0);
  const auto second = dog.epochs()[0];
  after[1].diagnostics.energies.kinetic = 100.0;
  dog.add({21, 2.1, 0.1, 0.0}, before, after);
  dog.take_back();
  EXPECT_EQ(dog.off()[1], 15.0);
  ASSERT_EQ(dog.epochs().size(), static_cast<std::size_t>(Watchdog::most_rows));
  EXPECT_EQ(dog.epochs().front().step, second.step);
  EXPECT_EQ(dog.rows(1).front().kinetic, 20.0 - Watchdog::most_rows + 1.0);
  EXPECT_EQ(dog.rows(1).back().kinetic, 20.0);
}

TEST(watchdog, the_worst_is_a_body_or_a_pair_and_what_is_no_number_beats_all) {
  Watchdog dog(3);
  std::vector<BodyNotice> before(3), after(3);
  after[2].diagnostics.energies.internal = -3.0;
  dog.add({1, 0.1, 0.1, 0.0}, before, after);
  EXPECT_EQ(dog.worst(after).body, 2);
  EXPECT_EQ(dog.worst(after).other, no_index);
  EXPECT_EQ(dog.worst(after).off, -3.0);
  EXPECT_EQ(dog.worst(after).share, 1.0);
  after[0].worst_pair = {1, 0.0, 5.0, 0.0, 0.0, 0.0};
  after[0].pairs_off = 6.0;
  EXPECT_EQ(dog.worst(after).body, 0);
  EXPECT_EQ(dog.worst(after).other, 1);
  EXPECT_EQ(dog.worst(after).share, 5.0 / 9.0);
  before = after;
  after[1].diagnostics.energies.internal = NAN;
  dog.add({2, 0.2, 0.1, 0.0}, before, after);
  EXPECT_EQ(dog.worst(after).body, 1);
  EXPECT_EQ(dog.worst(after).share, 1.0);
}

TEST(watchdog, a_drift_names_the_pair_that_makes_it_with_node_element_and_history) {
  auto d = two_falls(0.5, 8.0);
  d.run.energy_drift_limit = 1.0e-5;
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.2);
  ASSERT_EQ(report.fault.kind, FaultKind::energy_drift);
  EXPECT_EQ(report.fault.body, body_of(model, "fast ball"));
  EXPECT_EQ(report.fault.other, body_of(model, "fast plate"));
  EXPECT_GT(report.fault.share, 0.9);
  ASSERT_NE(report.fault.node, no_index);
  ASSERT_NE(report.fault.element, no_index);
  const Index a = model.node_body[at(report.fault.node)], b = contact::body_of_element(model, report.fault.element);
  EXPECT_EQ(std::min(a, b), report.fault.body);
  EXPECT_EQ(std::max(a, b), report.fault.other);
  EXPECT_NE(report.fault.message.find("body \"fast ball\" with body \"fast plate\""), std::string::npos)
      << report.fault.message;
  EXPECT_NE(report.fault.cure.find("penalty_scale"), std::string::npos) << report.fault.cure;
  ASSERT_EQ(report.fault.rows.size(), report.fault.epochs.size());
  ASSERT_EQ(report.fault.rows_other.size(), report.fault.epochs.size());
  EXPECT_EQ(report.fault.epochs.back().step, simulation.state().step);
  EXPECT_EQ(report.fault.epochs.back().energy_error, report.energy_error);
}

TEST(watchdog, an_epoch_that_goes_off_at_once_is_done_again_with_half_the_step_and_the_run_goes_on) {
  auto d = two_falls(0.0, 5.0);
  d.run.energy_drift_limit = 1.15e-4;
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  EpochReport report;
  double before = 0.0;
  while (report.retried.kind == FaultKind::none && report.fault.kind == FaultKind::none) {
    ASSERT_LT(simulation.state().time, 0.05);
    before = simulation.state().time;
    report = simulation.run_epoch(never);
  }
  ASSERT_EQ(report.retried.kind, FaultKind::energy_drift);
  EXPECT_EQ(report.retried.body, body_of(model, "fast ball"));
  EXPECT_EQ(report.fault.kind, FaultKind::none) << report.fault.message;
  EXPECT_LE(report.energy_error, 1.15e-4);
  EXPECT_GE(report.rollbacks, 1);
  EXPECT_LE(report.dt, 0.51 * model.run.safety * model.first_critical_step);
  EXPECT_LE(report.steps, 2 * model.run.epoch_steps);
  EXPECT_NEAR(simulation.state().time - before, report.dt * report.steps, 1.0e-12);
  EXPECT_EQ(simulation.extremes().retries, 1);

  // A run that is taken up there knows of it, and goes on alike.
  std::vector<Index> all(model.bodies.size());
  for (std::size_t b = 0; b < all.size(); ++b) {
    all[b] = static_cast<Index>(b);
  }
  const std::vector<Bytes> pieces{simulation.piece(all)};
  Simulation other(model, solve::KernelChoice::automatic, World::alone(), pieces);
  for (int i = 0; i < 3; ++i) {
    const EpochReport one = simulation.run_epoch(never), two = other.run_epoch(never);
    EXPECT_EQ(one.fault.message, two.fault.message);
    EXPECT_EQ(one.dt, two.dt);
    ASSERT_EQ(model::state_hash(model, simulation.state()), model::state_hash(model, other.state()));
  }
  EXPECT_EQ(simulation.extremes().retries, other.extremes().retries);
}

TEST(watchdog, a_fault_that_comes_again_ends_the_run_after_one_retry) {
  auto d = two_falls(0.0, 5.0);
  d.run.energy_drift_limit = 1.0e-9;
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.2);
  EXPECT_EQ(report.fault.kind, FaultKind::energy_drift);
  EXPECT_EQ(report.retried.kind, FaultKind::energy_drift);
  EXPECT_EQ(simulation.extremes().retries, 1);
}

TEST(watchdog, a_drift_that_has_been_coming_is_not_tried_again) {
  auto d = two_falls(0.0, 5.0);
  d.contact.penalty_scale = 0.02;
  d.run.energy_drift_limit = 1.0;
  d.run.epoch_steps = 4;
  model::Model model = test::build(d);
  Simulation probe(model, solve::KernelChoice::automatic);
  // A bound between the errors of two epochs, of which the second one has a little more.
  double limit = 0.0;
  for (int i = 0; i < 400 && limit == 0.0; ++i) {
    const double so_far = probe.extremes().energy_error, error = probe.run_epoch(never).energy_error;
    limit = error > so_far && so_far > 0.7 * error && so_far > 1.0e-6 ? 0.5 * (error + so_far) : 0.0;
  }
  ASSERT_GT(limit, 0.0);
  model.run.energy_drift_limit = limit;
  Simulation simulation(model, solve::KernelChoice::automatic);
  EpochReport report;
  for (int i = 0; i < 400 && report.fault.kind == FaultKind::none; ++i) {
    report = simulation.run_epoch(never);
    ASSERT_EQ(report.retried.kind, FaultKind::none);
  }
  EXPECT_EQ(report.fault.kind, FaultKind::energy_drift);
}

TEST(watchdog, a_step_that_collapses_through_contact_is_told_from_one_that_an_element_has) {
  auto d = two_falls(0.0, 5.0);
  d.contact.stiffness = 1.0e14;
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.05);
  ASSERT_EQ(report.fault.kind, FaultKind::step_collapsed);
  EXPECT_NE(report.fault.message.find("through the stiffness of contact"), std::string::npos) << report.fault.message;
  EXPECT_NE(report.fault.message.find("body \"fast"), std::string::npos) << report.fault.message;
  EXPECT_EQ(report.fault.message.find("slow"), std::string::npos) << report.fault.message;
  EXPECT_NE(report.fault.cure.find("contact.stiffness"), std::string::npos) << report.fault.cure;
  EXPECT_EQ(model.node_body[at(report.fault.node)], report.fault.body);
  EXPECT_EQ(contact::body_of_element(model, report.fault.element), report.fault.other);
}

TEST(watchdog, a_step_that_collapses_through_a_wall_names_the_wall_and_the_body) {
  auto d = two_falls(0.0, 0.0);
  d.contact.enabled = false;
  d.bodies.back().velocity = {0.0, 0.0, -1.0};
  d.planes.push_back({{"floor", 1.0e14}, {0.0, 0.0, -0.02}, {0.0, 0.0, 1.0}});
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.05);
  ASSERT_EQ(report.fault.kind, FaultKind::step_collapsed);
  EXPECT_NE(report.fault.message.find("rigid wall \"floor\" on node"), std::string::npos) << report.fault.message;
  EXPECT_EQ(model.node_body[at(report.fault.node)], report.fault.body);
  EXPECT_NE(report.fault.message.find(model.bodies[at(report.fault.body)].name), std::string::npos);
}

TEST(watchdog, a_rigid_body_that_turns_too_fast_is_not_called_a_crushed_element) {
  auto d = two_falls(0.0, 0.0);
  d.bodies.back().rigid = true;
  d.bodies.back().angular_velocity = {0.0, 0.0, 1.0e6};
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.05);
  ASSERT_EQ(report.fault.kind, FaultKind::step_collapsed);
  EXPECT_NE(report.fault.message.find("because the rigid body \"calm\" turns too fast"), std::string::npos)
      << report.fault.message;
  EXPECT_EQ(report.fault.body, body_of(model, "calm"));
  EXPECT_EQ(report.fault.cure.find("crushed"), std::string::npos) << report.fault.cure;
}

TEST(watchdog, a_number_that_is_not_finite_in_contact_names_the_other_body_too) {
  auto d = two_falls(0.0, 1.0);
  test::add_box_set(d, "under", {4.9, -0.1, -0.01}, {5.1, 0.1, 0.01});
  const double late = 0.02;
  d.curves.push_back({"bang", {{late, 0.0}, {late + 1.0e-9, 1.0}}, {}});
  d.forces.push_back({"under", {0.0, 1.0e308, 1.0e308}, {}, false, "bang", {}});
  const model::Model model = test::build(d);
  Simulation simulation(model, solve::KernelChoice::automatic);
  const EpochReport report = run(simulation, 0.05);
  ASSERT_EQ(report.fault.kind, FaultKind::not_finite);
  EXPECT_EQ(report.retried.kind, FaultKind::not_finite) << "tried again once";
  EXPECT_EQ(report.fault.body, body_of(model, "fast plate"));
  EXPECT_GT(simulation.state().time, 0.9 * late) << "the results end with the last sound state";
}

}  // namespace
}  // namespace fexp::cluster
