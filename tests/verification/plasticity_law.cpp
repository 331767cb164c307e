// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "support/layered.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using test::verify;

const physics::J2Linear steel{{7850.0, 200e9, 0.3}, 250e6, 2e9};

/// Stretches in x with no stress in y, as a tensile test does.
void pull(test::PointDriver<physics::J2Linear>& driver, double strain) {
  const physics::LayerPoint<double> start = driver.point;
  const auto stress_yy = [&](double eyy) {
    driver.point = start;
    driver.stretch({strain, eyy, 0.0});
    return test::components(driver.point)[1];
  };
  double a = -0.3 * strain, b = -0.5 * strain, fa = stress_yy(a), fb = stress_yy(b);
  for (int i = 0; i < 50 && fb != fa && std::abs(fb) > 1e-6; ++i) {
    const double next = b - fb * (b - a) / (fb - fa);
    a = b;
    fa = fb;
    b = next;
    fb = stress_yy(b);
  }
}

TEST(j2_law, follows_the_tensile_test) {
  test::PointDriver<physics::J2Linear> driver(steel);
  for (int i = 0; i < 100; ++i) {
    pull(driver, 1e-4);
  }
  verify({"10", "J2 law, plane stress", "uniaxial stress at 1 % strain [MPa]", 267.5,
          1e-6 * test::components(driver.point)[0], 1e-9, true, "sy + Et (e - sy/E)"});
}

TEST(j2_law, follows_pure_shear) {
  test::PointDriver<physics::J2Linear> driver(steel);
  for (int i = 0; i < 100; ++i) {
    driver.stretch({0.0, 0.0, 2e-4});
  }
  // tau = ty + (g - ty/G) / (1/G + 3/H) with H = E Et/(E - Et)
  const double shear = 200e9 / 2.6, yield = 250e6 / std::sqrt(3.0), hardening = 200e9 * 2e9 / 198e9;
  const double stress = yield + (0.02 - yield / shear) / (1.0 / shear + 3.0 / hardening);
  verify({"10", "J2 law, plane stress", "shear stress at 2 % shear [MPa]", 1e-6 * stress,
          1e-6 * driver.point.stress.shear, 1e-9, true, "closed form, 156.436106"});
}

TEST(j2_law, follows_a_path_of_three_legs) {
  test::PointDriver<physics::J2Linear> driver(steel);
  for (const std::array<double, 3>& leg : {std::array{4e-6, 0.0, 0.0}, {0.0, 4e-6, 0.0}, {0.0, 0.0, 6e-6}}) {
    for (int i = 0; i < 1000; ++i) {
      driver.stretch(leg);
    }
  }
  const std::string title = "J2 law, path of 3 x 1000 steps", source = "independent code, fine steps";
  verify({"10", title, "sigma 11 [MPa]", 45.29, 1e-6 * test::components(driver.point)[0], 2e-3, true, source});
  verify({"10", title, "sigma 22 [MPa]", 58.23, 1e-6 * test::components(driver.point)[1], 2e-3, true, source});
  verify({"10", title, "sigma 12 [MPa]", 153.006, 1e-6 * driver.point.stress.shear, 2e-3, true, source});
}

/// Moment over that at first yield when the curvature is twice that at first yield. With nu = 1/2 the strains across
/// are those of a beam, whether elastic or plastic.
double moment_ratio(int points) {
  const double young = 200e9, yield = 250e6, thickness = 0.01;
  test::LayeredDriver<physics::J2Linear> beam({{1.0, young, 0.5}, yield, 0.0}, thickness, points);
  const double first_yield = 2.0 * yield / (young * thickness);
  for (int i = 0; i < 200; ++i) {
    const double k = 0.01 * first_yield;
    beam.step({0.0, 0.0, 0.0, k, -0.5 * k, 0.0, 0.0, 0.0, {}});
  }
  return beam.resultants.mxx / (yield * thickness * thickness / 6.0);
}

TEST(layered_shell, bends_beyond_first_yield_as_its_points_tell) {
  const std::string title = "bending, perfectly plastic", quantity = "M/My at twice the curvature, {} Gauss points";
  // 3 sum of weight x position x min(2 position, 1) by the rules' tables
  const double three = 3.0 * 5.0 / 9.0 * std::sqrt(0.6);
  const double five = 3.0 * (0.23692688505618909 * 0.90617984593866399 + 0.47862867049936647 * 0.53846931010568309);
  const double seven = 3.0 * (0.12948496616886969 * 0.94910791234275852 + 0.27970539148927667 * 0.74153118559939444 +
                              0.38183005050511894 * 2.0 * 0.40584515137739717 * 0.40584515137739717);
  const std::string source = "sum over the points";
  verify({"11", title, fmt::format(fmt::runtime(quantity), 3), three, moment_ratio(3), 1e-6, true, source});
  verify({"11", title, fmt::format(fmt::runtime(quantity), 5), five, moment_ratio(5), 1e-6, true, source});
  verify({"11", title, fmt::format(fmt::runtime(quantity), 7), seven, moment_ratio(7), 1e-6, true, source});
  verify({"11", title, "the same, 7 points, against the exact", 1.375, moment_ratio(7), 6e-3, true,
          "(3 - 1/4)/2, beam theory"});
}

}  // namespace
}  // namespace fexp
