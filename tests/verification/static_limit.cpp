// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "solve/diagnostics.hpp"
#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using test::verify;

/// Steps a damped model to `time` and holds it to be at rest: what still moves is 1e-12 of the stored energy.
void settle(const model::Model& model, test::DirectRun& run, double time) {
  const double dt = 0.9 * model.first_critical_step;
  run.advance(dt, static_cast<Index>(time / dt));
  const solve::Energies energies = solve::diagnostics(model, run.state).energies;
  EXPECT_LT(energies.kinetic, 1e-12 * energies.internal);
}

TEST(large_rotation, of_a_strip_under_end_shear_is_as_known) {
  auto d = test::description({1.0, 1.2e6, 0.0}, 0.1);
  d.run.damping = 2.5;
  test::add_body(d, "strip", model::Plate{10.0, 1.0, 16, 1, "one"});
  test::add_box_set(d, "root", {-0.01, -1, -1}, {0.01, 2, 1});
  test::add_box_set(d, "tip", {9.99, -1, -1}, {10.01, 2, 1});
  test::fix(d, "root", {"x", "y", "z", "rx", "ry", "rz"});
  d.forces.push_back({"tip", {0, 0, 4.0}, {}, true, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);
  settle(model, run, 25.0);
  Vec3d moved;
  for (const Index n : test::nodes_of(model, "tip")) {
    moved += 0.5 * (run.state.motion[at(n)].position - model.reference_position[at(n)]);
  }
  verify({"21", "strip under end shear, 16 x 1", "-u of the tip", 3.2894, -moved.x, 1e-3, true, "elastica"});
  verify({"21", "strip under end shear, 16 x 1", "w of the tip", 6.6996, moved.z, 1e-3, true, "elastica"});
}

/// Deflection of the middle of the free edge of the Scordelis-Lo roof, a quarter of it with n x n cells. The load is
/// 1e-4 of the usual one and the result scaled up: the reference is that of small displacements.
double roof_deflection(int cells) {
  const double thickness = 0.25, part = 1e-4;
  auto d = test::description({1.0, 4.32e8, 0.0}, thickness);
  d.run.damping = 60.0;
  test::add_body(d, "roof", model::Cylinder{25.0, 25.0, cells, cells, 40.0});
  test::add_box_set(d, "diaphragm", {-100, -100, -0.001}, {100, 100, 0.001});
  test::add_box_set(d, "middle", {-100, -100, 24.999}, {100, 100, 25.001});
  test::add_box_set(d, "crown", {-100, -0.001, -100}, {100, 0.001, 100});
  test::add_box_set(d, "free corner", {-100, 16.06, 24.999}, {100, 100, 25.001});
  test::fix(d, "diaphragm", {"x", "y"});
  d.symmetry.push_back({"middle", {0, 0, 1}, {}});
  d.symmetry.push_back({"crown", {0, 1, 0}, {}});
  d.gravity.push_back({{-part * 90.0 / thickness, 0, 0}, "", {}});
  const model::Model model = test::build(d);
  const Index corner = test::nodes_of(model, "free corner").at(0);
  test::DirectRun run(model);
  settle(model, run, 0.6);
  return (model.reference_position[at(corner)].x - run.state.motion[at(corner)].position.x) / part;
}

/// Deflections known of the C0 triangle: `meshes` are pairs of cells and deflection, ascending.
void verify_roof(const std::vector<std::pair<int, double>>& meshes, double tolerance) {
  double last = 0.0;
  for (const auto& [cells, known] : meshes) {
    const double deflection = roof_deflection(cells);
    EXPECT_GT(deflection, last);
    EXPECT_LT(deflection, 1.001 * 0.3006) << "softer than the reference: does the drilling tie hold?";
    verify({"17", "Scordelis-Lo roof", fmt::format("deflection [ft], {0} x {0} cells", cells), known, deflection, 1e-3,
            true, "independent code, same element"});
    last = deflection;
  }
  verify({"17", "Scordelis-Lo roof", fmt::format("the same, {0} x {0} cells", meshes.back().first), 0.3006, last,
          tolerance, true, "small displacements"});
}

TEST(scordelis_lo_roof, converges_from_below) { verify_roof({{8, 0.2633}, {16, 0.2895}, {32, 0.2980}}, 0.01); }

TEST(scordelis_lo_roof, long_converges_on_a_fine_mesh) { verify_roof({{64, 0.3006}}, 2e-3); }

}  // namespace
}  // namespace fexp
