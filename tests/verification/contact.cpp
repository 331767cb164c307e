// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cluster/simulation.hpp"
#include "support/contact.hpp"
#include "support/crossings.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using test::verify;

Vec3d momentum(const model::Model& model, const model::State& state, Index body) {
  Vec3d sum;
  for (Index n = model.bodies[at(body)].nodes.begin; n < model.bodies[at(body)].nodes.end; ++n) {
    sum += model.mass[at(n)] * state.motion[at(n)].velocity;
  }
  return sum;
}

/// A square tube of side 1 and length `cells`, closed by a cap of two triangles at the end that meets the other bar;
/// without Poisson's ratio it is a bar in which plane waves run.
model::Mesh capped_bar(double length, int cells) {
  model::Mesh m = model::generate_mesh(model::SquareTube{1.0, length, 1, cells});
  std::vector<Index> end;
  for (std::size_t n = 0; n < m.position.size(); ++n) {
    if (m.position[n].z == length) {
      end.push_back(static_cast<Index>(n));
    }
  }
  EXPECT_EQ(end.size(), 4U);
  std::sort(end.begin(), end.end(), [&](Index a, Index b) {
    const Vec3d &p = m.position[at(a)], &q = m.position[at(b)];
    return std::atan2(p.y, p.x) < std::atan2(q.y, q.x);
  });
  m.triangle.push_back({end[0], end[1], end[2]});
  m.triangle.push_back({end[0], end[2], end[3]});
  m.part.resize(m.triangle.size(), 0);
  return m;
}

// So that faces meet, the strips are the four walls of thin bars that bear caps. They are slow, as the exact answer is
// that of small strains.
TEST(two_equal_bars, swap_velocities_in_the_time_a_wave_takes_there_and_back) {
  const double length = 40.0, speed = 0.002, thickness = 0.02;
  const int cells = 160;
  auto d = test::description({1.0, 1.0, 0.0}, thickness);
  d.sections.push_back({"cap", "m", thickness, {}});
  d.contact.enabled = true;
  d.contact.self = false;
  d.run.epoch_steps = 8;
  test::add_body(d, "A", model::CubedSphere{}).velocity = {0.0, 0.0, speed};
  model::BodyDescription& b = test::add_body(d, "B", model::CubedSphere{});
  b.rotate.push_back({{1.0, 0.0, 0.0}, 180.0, {}});
  b.translate = {0.0, 0.0, 2.0 * length + thickness + 0.01};
  const model::Mesh bar = capped_bar(length, cells);
  const model::Model model = test::build(d, {bar, bar});
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  double first = 0.0, last = 0.0;
  const double end = 0.01 / speed + 2.0 * length * 1.5;
  while (simulation.state().time < end) {
    const auto report = simulation.run_epoch(end);
    ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.active_pairs > 0) {
      first = first == 0.0 ? simulation.state().time : first;
      last = simulation.state().time;
    }
  }
  const double mass = model.bodies[1].mass;
  const double v_b = momentum(model, simulation.state(), 1).z / (mass * speed);
  const double v_a = momentum(model, simulation.state(), 0).z / (mass * speed);
  const auto& x = simulation.extremes();
  verify({"26", "two equal bars end to end", "velocity of B / first of A", 1.0, v_b, 0.01, true, "exact"});
  verify({"26", "two equal bars end to end", "velocity of A / its first", 0.0, v_a, 0.01, false, "exact"});
  verify({"26", "two equal bars end to end", "contact time", 2.0 * length, last - first, 0.03, true, "2 L / c"});
  verify({"26", "two equal bars end to end", "energy error", 0.0, x.energy_error, 5e-3, false, "balance"});
  verify({"26", "two equal bars end to end", "momentum error", 0.0, x.linear_momentum_error, 1e-12, false, "exact"});
  verify({"26", "two equal bars end to end", "angular momentum error", 0.0, x.angular_momentum_error, 1e-12, false,
          "exact"});
}

TEST(four_spheres, of_the_paper_meet_rebound_and_part) {
  auto d = test::description({7850.0, 2.1e11, 0.3}, 0.01);
  d.contact.enabled = true;
  const double speed = 10.0;
  for (int i = 0; i < 4; ++i) {
    model::BodyDescription& body = test::add_body(d, "sphere " + std::to_string(i), model::CubedSphere{0.5, 4});
    body.translate = {std::array{0.0, 1.1, 3.3, 4.4}[at(i)], 0.0, 0.0};
    // Small velocities across keep edges from meeting edges, as in the paper.
    body.velocity = {speed * std::array{1.0, -0.2, 0.2, -1.0}[at(i)], 0.0, i % 2 == 0 ? 0.02 : -0.02};
  }
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const double end = 0.06;
  while (simulation.state().time < end) {
    const auto report = simulation.run_epoch(end);
    ASSERT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
  }
  const auto& x = simulation.extremes();
  EXPECT_GT(x.most_active_pairs, 0);
  EXPECT_LT(x.fewest_islands, 4);
  verify({"31", "four spheres", "linear momentum error", 0.0, x.linear_momentum_error, 1e-12, false, "exact"});
  verify({"31", "four spheres", "angular momentum error", 0.0, x.angular_momentum_error, 1e-12, false, "exact"});
  verify({"31", "four spheres", "energy error", 0.0, x.energy_error, 0.01, false, "balance"});
  verify({"31", "four spheres", "islands at the end", 4.0, static_cast<double>(simulation.present().islands), 0.0,
          false, "the paper's table 1"});
  // The faster sphere of each pair has been thrown back.
  EXPECT_LT(momentum(model, simulation.state(), 0).x / model.bodies[0].mass, 0.0);
  EXPECT_GT(momentum(model, simulation.state(), 3).x / model.bodies[3].mass, 0.0);
}

/// Steps to the end; the most crossings of mid-surfaces at the end of any epoch.
int most_crossings(const model::Model& model, double end, cluster::Simulation& simulation) {
  int most = 0;
  while (simulation.state().time < end) {
    const auto report = simulation.run_epoch(end);
    EXPECT_EQ(report.fault.kind, cluster::FaultKind::none) << report.fault.message;
    if (report.fault.kind != cluster::FaultKind::none) {
      break;
    }
    most = std::max(most, test::crossings(model, simulation.state()));
  }
  return most;
}

/// Two steel plates at right angles that fly at each other, so that their edges meet crosswise between nodes.
model::Description crossed_plates() {
  auto d = test::description({7850.0, 2.1e11, 0.3}, 0.01);
  d.contact.enabled = true;
  d.run.epoch_steps = 8;
  model::BodyDescription& a = test::add_body(d, "A", test::plate(1.0, 1.0, 5, 5));
  a.velocity = {10.0, 0.0, 0.0};
  model::BodyDescription& b = test::add_body(d, "B", test::plate(1.0, 1.0, 5, 5));
  b.rotate.push_back({{1.0, 0.0, 0.0}, 90.0, {}});
  b.translate = {1.02, 0.5, -0.5};
  return d;
}

TEST(crossed_plates, that_meet_edge_to_edge_do_not_cross_and_part) {
  const model::Model model = test::build(crossed_plates());
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const int crossings = most_crossings(model, 0.006, simulation);
  const auto& x = simulation.extremes();
  verify(
      {"33", "crossed plates, edge to edge", "crossings of mid-surfaces", 0.0, double(crossings), 0.0, false, "exact"});
  verify({"33", "crossed plates, edge to edge", "energy error", 0.0, x.energy_error, 0.01, false, "balance"});
  verify({"33", "crossed plates, edge to edge", "linear momentum error", 0.0, x.linear_momentum_error, 1e-12, false,
          "exact"});
  verify({"33", "crossed plates, edge to edge", "angular momentum error", 0.0, x.angular_momentum_error, 1e-12, false,
          "exact"});
  EXPECT_GT(momentum(model, simulation.state(), 1).x, momentum(model, simulation.state(), 0).x);
  EXPECT_EQ(simulation.present().active_pairs, 0);
}

TEST(crossed_plates, cross_where_edges_are_left_out) {
  auto d = crossed_plates();
  d.contact.edges = false;
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  EXPECT_GT(most_crossings(model, 0.006, simulation), 0);
}

// The spheres are turned so that an edge of one meets an edge of the other, and have no velocities across.
TEST(four_spheres, meet_edge_to_edge_without_velocities_across) {
  auto d = test::description({7850.0, 2.1e11, 0.3}, 0.01);
  d.contact.enabled = true;
  d.run.epoch_steps = 8;
  for (int i = 0; i < 4; ++i) {
    model::BodyDescription& body = test::add_body(d, "sphere " + std::to_string(i), model::CubedSphere{0.5, 4});
    // By half a cell about y the one, about z the other: the middles of crossing edges meet.
    body.rotate.push_back({i % 2 == 0 ? Vec3d{0.0, 1.0, 0.0} : Vec3d{0.0, 0.0, 1.0}, 11.25, {}});
    body.translate = {std::array{0.0, 1.1, 3.3, 4.4}[at(i)], 0.0, 0.0};
    body.velocity = {10.0 * std::array{1.0, -0.2, 0.2, -1.0}[at(i)], 0.0, 0.0};
  }
  const model::Model model = test::build(d);
  cluster::Simulation simulation(model, solve::KernelChoice::automatic);
  const int crossings = most_crossings(model, 0.06, simulation);
  const auto& x = simulation.extremes();
  verify(
      {"31", "four spheres, edge to edge", "crossings of mid-surfaces", 0.0, double(crossings), 0.0, false, "exact"});
  verify({"31", "four spheres, edge to edge", "energy error", 0.0, x.energy_error, 0.01, false, "balance"});
  verify({"31", "four spheres, edge to edge", "linear momentum error", 0.0, x.linear_momentum_error, 1e-12, false,
          "exact"});
  EXPECT_LT(momentum(model, simulation.state(), 0).x, 0.0);
  EXPECT_GT(momentum(model, simulation.state(), 3).x, 0.0);
}

}  // namespace
}  // namespace fexp
