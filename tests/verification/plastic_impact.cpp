// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "solve/diagnostics.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using test::verify;

/// A model of one metal.
model::Description metal(const physics::J2Linear& law, double thickness, int points) {
  auto d = test::description({law.density, law.young, law.poisson}, thickness);
  d.materials[0].law = law;
  d.sections[0].points = points;
  return d;
}

/// What the nodes on the rim of a struck part get.
enum class Rim { share, whole };

/// Gives the nodes of `struck` elements a velocity: those on the rim whole, or the momentum of the struck part of their
/// mass.
void strike(model::Model& model, Rim rim, const std::function<bool(const Vec3d& centre)>& struck,
            const std::function<Vec3d(const Vec3d& position)>& velocity) {
  std::vector<double> part(model.mass.size()), whole(model.mass.size());
  for (Index e = 0; e < model.element_count(); ++e) {
    const auto& t = model.triangle[at(e)];
    const Vec3d centre = (1.0 / 3.0) * (model.reference_position[at(t[0])] + model.reference_position[at(t[1])] +
                                        model.reference_position[at(t[2])]);
    for (const Index n : t) {
      whole[at(n)] += model.reference_area[at(e)];
      part[at(n)] += struck(centre) ? model.reference_area[at(e)] : 0.0;
    }
  }
  for (std::size_t n = 0; n < part.size(); ++n) {
    const double share = rim == Rim::share || part[n] == 0.0 ? part[n] / whole[n] : 1.0;
    model.initial_velocity[n] = share * velocity(model.reference_position[n]);
  }
}

/// Steps with 0.9 of the smallest present critical step, looked at every 20 steps, and holds the energies to balance.
void run_to(const model::Model& model, test::DirectRun& run, double time, const std::function<void()>& look) {
  const double start = solve::diagnostics(model, run.state).energies.balance();
  while (run.state.time < time) {
    double step = HUGE_VAL;
    for (Index b = 0; b < model.body_count(); ++b) {
      step = std::min(step, solve::body_critical_step(model, run.state, b).step);
    }
    for (int i = 0; i < 20 && run.state.time < time; ++i) {
      run.advance(0.9 * step, 1);
      look();
    }
  }
  EXPECT_NEAR(solve::diagnostics(model, run.state).energies.balance(), start, 1e-3 * start);
}

/// H. A. Balmer and E. A. Witmer's clamped beam under a sheet of explosive.
TEST(clamped_beam, under_an_explosive_deflects_as_known) {
  auto d = metal({{2.61e-4, 10.4e6, 0.33}, 41400.0, 10.4e3}, 0.125, 9);
  test::add_body(d, "beam", model::Plate{10.0, 1.2, 80, 8, "one"});
  test::add_box_set(d, "left", {-0.01, -1, -1}, {0.01, 2, 1});
  test::add_box_set(d, "right", {9.99, -1, -1}, {10.01, 2, 1});
  test::add_box_set(d, "middle", {4.99, 0.59, -1}, {5.01, 0.61, 1});
  test::fix(d, "left", {"x", "y", "z", "rx", "ry", "rz"});
  test::fix(d, "right", {"x", "y", "z", "rx", "ry", "rz"});
  model::Model model = test::build(d);
  strike(
      model, Rim::share, [](const Vec3d& centre) { return std::abs(centre.x - 5.0) < 1.0; },
      [](const Vec3d&) {
        return Vec3d{0.0, 0.0, -5200.0};
      });
  const Index middle = test::nodes_of(model, "middle").at(0);
  test::DirectRun run(model);
  double peak = 0.0, peak_time = 0.0;
  run_to(model, run, 0.6e-3, [&] {
    const double down = -run.state.motion[at(middle)].position.z;
    if (down > peak) {
      peak = down;
      peak_time = run.state.time;
    }
  });
  const std::string title = "clamped beam, explosive, 80 x 8";
  verify({"24", title, "peak deflection [in]", 0.7551, peak, 0.02, true, "one-dimensional code"});
  verify({"24", title, "at the time of [ms]", 0.468, 1e3 * peak_time, 0.05, true, "one-dimensional code"});
}

/// Half of H. A. Balmer and E. A. Witmer's panel of 120 degrees, clamped along its straight edges and hinged at the
/// ends, with the velocity that a sheet of explosive gives to a part of it. Largest deflections.
void verify_panel(int around, int along, double known_middle, double known_quarter) {
  constexpr double radius = 2.9375, length = 12.56, thickness = 0.125, speed = 5650.0, crown = 0.5 * 3.08;
  auto d = metal({{2.5e-4, 10.5e6, 0.33}, 44000.0, 0.0}, thickness, 3);
  test::add_body(d, "panel", model::Cylinder{radius, length, around, along, 60.0});
  const double edge_x = radius * std::cos(std::numbers::pi / 3.0), edge_y = radius * std::sin(std::numbers::pi / 3.0);
  test::add_box_set(d, "edge", {edge_x - 1e-4, edge_y - 1e-4, -1}, {edge_x + 1e-4, edge_y + 1e-4, 20});
  test::add_box_set(d, "start", {-10, -10, -1e-4}, {10, 10, 1e-4});
  test::add_box_set(d, "end", {-10, -10, length - 1e-4}, {10, 10, length + 1e-4});
  test::add_box_set(d, "crown", {-10, -1e-4, -1}, {10, 1e-4, 20});
  test::add_box_set(d, "middle", {-10, -1e-4, 6.28 - 1e-3}, {10, 1e-4, 6.28 + 1e-3});
  test::add_box_set(d, "quarter", {-10, -1e-4, 9.42 - 1e-3}, {10, 1e-4, 9.42 + 1e-3});
  test::fix(d, "edge", {"x", "y", "z", "rx", "ry", "rz"});
  test::fix(d, "start", {"x", "y", "z"});
  test::fix(d, "end", {"x", "y", "z"});
  d.symmetry.push_back({"crown", {0, 1, 0}, {}});
  model::Model model = test::build(d);
  strike(
      model, Rim::whole,
      [&](const Vec3d& centre) { return centre.z < 10.205 && radius * std::atan2(centre.y, centre.x) < crown; },
      [&](const Vec3d& x) {
        return -speed / std::hypot(x.x, x.y) * Vec3d{x.x, x.y, 0.0};
      });
  const Index middle = test::nodes_of(model, "middle").at(0), quarter = test::nodes_of(model, "quarter").at(0);
  test::DirectRun run(model);
  const std::string title = fmt::format("panel, explosive, half {} x {}", around, along);
  verify({"23", title, "initial kinetic energy [in lb]", 7838.0, solve::diagnostics(model, run.state).energies.kinetic,
          0.065, true, "of the struck part; the nodes on its rim move whole"});
  double at_middle = 0.0, at_quarter = 0.0;
  const auto deflection = [&](Index node) {
    return model.reference_position[at(node)].x - run.state.motion[at(node)].position.x;
  };
  run_to(model, run, 1.0e-3, [&] {
    at_middle = std::max(at_middle, deflection(middle));
    at_quarter = std::max(at_quarter, deflection(quarter));
  });
  verify({"23", title, "peak deflection at 6.28 in [in]", known_middle, at_middle, 0.03, true,
          "independent code, same element"});
  verify({"23", title, "peak deflection at 9.42 in [in]", known_quarter, at_quarter, 0.03, true,
          "independent code, same element"});
}

TEST(explosive_panel, deflects_as_known) { verify_panel(16, 32, 1.221, 0.620); }

TEST(explosive_panel, long_deflects_as_known_on_a_fine_mesh) { verify_panel(32, 64, 1.237, 0.629); }

}  // namespace
}  // namespace fexp
