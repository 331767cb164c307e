// SPDX-License-Identifier: Apache-2.0
#include "physics/j2_plane_stress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/layered.hpp"

namespace fexp::physics {
namespace {

constexpr double young = 200e9, poisson = 0.3;

J2Linear linear(double tangent = 2e9) { return {{7850.0, young, poisson}, 250e6, tangent}; }
J2Power power_law(double n = 0.36) { return {{7850.0, young, poisson}, 350e6, 275e6, n}; }
J2Table table(std::initializer_list<std::array<double, 2>> points) {
  J2Table law{{7850.0, young, poisson}, {}};
  for (const auto& point : points) {
    law.table.append(point);
  }
  return law;
}
JohnsonCook johnson_cook() {
  JohnsonCook law;
  static_cast<J2Power&>(law) = power_law();
  law.rate_sensitivity = 0.022;
  law.reference_rate = 1.0;
  return law;
}

/// Stretches a point at random and holds every step against the equations of [ST86], written with tensors: the new
/// stress is the trial stress less C times the plastic strain, which has the direction of the new stress.
template <class Law>
void expect_equations_hold(const Law& law, double largest_strain, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0), decade(-4.0, 0.0);
  const PlaneStressModuli c = law.moduli();
  int yielded = 0;
  for (int path = 0; path < 40; ++path) {
    test::PointDriver<Law> driver(law);
    for (int i = 0; i < 50; ++i) {
      const double size = largest_strain * std::pow(10.0, decade(random));
      const std::array<double, 3> e{size * unit(random), size * unit(random), size * unit(random)};
      const double old_strain = driver.point.strain, before = driver.yield_stress();
      const auto [old_xx, old_yy, old_xy] = test::components(driver.point);
      const double txx = old_xx + c.direct * e[0] + c.cross * e[1], tyy = old_yy + c.cross * e[0] + c.direct * e[1];
      const double txy = old_xy + c.shear * e[2];
      const double trial = std::sqrt(txx * txx - txx * tyy + tyy * tyy + 3.0 * txy * txy);
      const PointChange<double> change = driver.stretch(e);
      const auto [xx, yy, xy] = test::components(driver.point);
      const double q = test::von_mises(driver.point), dep = driver.point.strain - old_strain;
      if (trial <= before) {
        ASSERT_EQ(driver.point.strain, old_strain);
        ASSERT_NEAR(xx, txx, 1e-14 * (std::abs(txx) + std::abs(tyy)));
        continue;
      }
      ++yielded;
      ASSERT_GE(dep, 0.0);
      ASSERT_NEAR(q, driver.yield_stress(), 1e-9 * q) << "of a trial stress of " << trial;
      const double pxx = dep * (xx - 0.5 * yy) / q, pyy = dep * (yy - 0.5 * xx) / q, pxy = 3.0 * dep * xy / q;
      ASSERT_NEAR(xx, txx - c.direct * pxx - c.cross * pyy, 1e-9 * trial);
      ASSERT_NEAR(yy, tyy - c.cross * pxx - c.direct * pyy, 1e-9 * trial);
      ASSERT_NEAR(xy, txy - c.shear * pxy, 1e-9 * trial);
      // The difference of two strains has their rounding.
      ASSERT_NEAR(change.plastic_work, q * dep, 1e-9 * q * dep + 1e-15 * q * driver.point.strain);
      const double transverse = -poisson / young * (xx + yy - old_xx - old_yy) - (pxx + pyy);
      ASSERT_NEAR(change.transverse_strain, transverse, 1e-9 * (std::abs(transverse) + dep));
    }
  }
  EXPECT_GT(yielded, 200);
}

TEST(j2_plane_stress, return_satisfies_its_equations_with_linear_hardening) {
  expect_equations_hold(linear(), 0.01, 1);
  expect_equations_hold(linear(0.0), 0.01, 2);
  expect_equations_hold(linear(150e9), 0.1, 3);
}

TEST(j2_plane_stress, return_satisfies_its_equations_with_a_power_law) {
  expect_equations_hold(power_law(), 0.01, 4);
  expect_equations_hold(power_law(0.05), 1.0, 5);
  expect_equations_hold(power_law(1.0), 0.1, 6);
}

TEST(j2_plane_stress, return_satisfies_its_equations_with_tables_that_bend_either_way) {
  expect_equations_hold(table({{0.0, 300e6}}), 0.01, 7);
  expect_equations_hold(table({{0.0, 300e6}, {0.002, 300e6}, {0.01, 500e6}, {0.0101, 2000e6}}), 0.01, 8);
  expect_equations_hold(table({{0.0, 1e6}, {1e-6, 900e6}, {0.5, 901e6}, {0.501, 5e9}, {1.0, 50e9}}), 1.0, 9);
}

/// Cases for which Newton's method alone is slow or goes astray.
TEST(j2_plane_stress, return_is_found_from_far_and_from_near) {
  for (const double strain : {1e-12, 1e-9, 1e-6, 1e-3, 1.0, 100.0}) {
    for (const double n : {0.01, 0.3, 1.0}) {
      test::PointDriver<J2Power> driver(power_law(n));
      // To the surface, where the power law is steepest, then beyond.
      driver.stretch({350e6 * (1.0 - poisson * poisson) / young, -poisson * 350e6 / young, 0.0});
      driver.stretch({strain, -0.2 * strain, 0.7 * strain});
      const double q = test::von_mises(driver.point), yield = driver.yield_stress();
      EXPECT_LE(q, yield * (1.0 + 1e-9)) << strain << " " << n;
      EXPECT_TRUE(driver.point.strain == 0.0 || q >= yield * (1.0 - 1e-9)) << strain << " " << n;
    }
  }
}

TEST(j2_plane_stress, what_is_no_number_ends_and_stays_none) {
  test::PointDriver<J2Power> driver(power_law());
  driver.stretch({std::nan(""), 0.0, 0.0});
  EXPECT_TRUE(std::isnan(driver.point.stress.sum));
  driver.point = {{HUGE_VAL, 0.0, 0.0}, 0.0};
  driver.stretch({0.0, 0.0, 0.0});
  EXPECT_FALSE(std::isfinite(driver.point.stress.sum));
}

TEST(j2_plane_stress, yield_stress_grows_with_the_logarithm_of_the_rate) {
  const JohnsonCook law = johnson_cook();
  const auto yield_at = [&](double rate) {
    test::PointDriver<JohnsonCook> driver(law);
    // Pure shear: the effective rate is gxy/sqrt(3).
    const double dt = 1.0, shear = std::sqrt(3.0) * rate * dt;
    driver.stretch({0.0, 0.0, shear}, dt);
    return test::von_mises(driver.point) / driver.yield_stress();
  };
  EXPECT_NEAR(yield_at(0.5), 1.0, 1e-9) << "below the reference rate";
  EXPECT_NEAR(yield_at(1.0), 1.0, 1e-9);
  EXPECT_NEAR(yield_at(10.0), 1.0 + 0.022 * std::log(10.0), 1e-9);
  EXPECT_NEAR(yield_at(1e4), 1.0 + 0.022 * std::log(1e4), 1e-9);
}

TEST(j2_laws, tables_are_linear_between_points_and_constant_behind_them) {
  const TableHardening curve =
      std::get<TableHardening>(table({{0.0, 3.0}, {0.5, 4.0}, {1.0, 8.0}}).plasticity().hardening);
  double slope = 0.0;
  EXPECT_EQ(curve.at(0.0, slope), 3.0);
  EXPECT_EQ(slope, 2.0);
  EXPECT_EQ(curve.at(0.25, slope), 3.5);
  EXPECT_EQ(curve.at(0.5, slope), 4.0);
  EXPECT_EQ(slope, 8.0);
  EXPECT_EQ(curve.at(1.0, slope), 8.0);
  EXPECT_EQ(curve.at(7.0, slope), 8.0);
  EXPECT_EQ(slope, 0.0);
}

/// The series about a strain and the power itself, on both sides of where one takes over from the other.
TEST(j2_laws, a_power_law_is_the_same_by_its_series) {
  for (const double n : {0.01, 0.3, 0.7, 1.0}) {
    const PowerHardening curve{350e6, 275e6, n};
    for (const double strain : {0.0, 5e-7, 1e-6, 1e-5, 1e-3, 0.2}) {
      const YieldStress<double, PowerHardening> about(curve, strain);
      double slope = 0.0, exact_slope = 0.0;
      EXPECT_NEAR(about.stress, curve.at(strain, exact_slope), 1e-12 * about.stress);
      EXPECT_NEAR(about.slope, exact_slope, 1e-11 * exact_slope);
      for (const double part : {0.0, 1e-9, 1e-3, 0.0399, 0.0401, 3.0}) {
        const double exact = curve.at(strain + part * strain, exact_slope);
        EXPECT_NEAR(about.after(part * strain, slope), exact, 1e-12 * exact) << n << " " << strain << " " << part;
        EXPECT_NEAR(slope, exact_slope, 1e-11 * exact_slope) << n << " " << strain << " " << part;
      }
    }
  }
}

TEST(j2_laws, slopes_are_derivatives) {
  const auto check = [](const auto& curve, double strain) {
    double slope = 0.0, none = 0.0;
    static_cast<void>(curve.at(strain, slope));
    const double step = 1e-3 * strain;
    const double difference = (curve.at(strain + step, none) - curve.at(strain - step, none)) / (2.0 * step);
    EXPECT_NEAR(slope, difference, 1e-5 * slope);
  };
  for (const double strain : {1e-7, 1e-5, 1e-3, 0.1, 2.0}) {
    check(PowerHardening{350e6, 275e6, 0.36}, strain);
    check(LinearHardening{250e6, 2e9}, strain);
  }
}

}  // namespace
}  // namespace fexp::physics
