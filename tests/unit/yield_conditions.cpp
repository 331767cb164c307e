// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "physics/adiabatic_heating.hpp"
#include "physics/rate_dependence.hpp"
#include "support/layered.hpp"

/// What the yield stress depends on besides the plastic strain: temperature, rate, and the filter of the rate.
namespace fexp::physics {
namespace {

const AdiabaticHeating steel_heating{477.0, 1793.0, 293.0, 300.0, 1.03, 0.9};

JohnsonCook hot_steel(const AdiabaticHeating& heating = steel_heating) {
  JohnsonCook law;
  static_cast<J2Power&>(law) = J2Power{{7850.0, 200e9, 0.3, 0.014, 1.0}, 792e6, 510e6, 0.26};
  law.heating = heating;
  return law;
}

double softening(const AdiabaticHeating& h, double temperature) {
  const double ratio = (temperature - h.reference_temperature) / (h.melting_temperature - h.reference_temperature);
  return ratio <= 0.0 ? 1.0 : std::max(1.0 - std::pow(std::min(ratio, 1.0), h.exponent), 1e-6);
}

TEST(adiabatic_heating, softens_from_the_reference_to_the_melting_temperature) {
  for (const double exponent : {0.3, 1.0, 1.03, 10.0}) {
    AdiabaticHeating h = steel_heating;
    h.exponent = exponent;
    const ThermalSoftening s = ThermalSoftening::of(h, 7850.0);
    EXPECT_TRUE(s.heats());
    EXPECT_EQ(s.factor(293.0), 1.0);
    EXPECT_EQ(s.factor(-1e4), 1.0) << "colder than the reference";
    for (const double temperature : {293.001, 300.0, 1043.0, 1700.0, 1792.0}) {
      EXPECT_NEAR(s.factor(temperature), softening(h, temperature), 1e-11) << exponent << " " << temperature;
    }
    EXPECT_EQ(s.factor(1793.0), ThermalSoftening::least_factor);
    EXPECT_EQ(s.factor(1e9), ThermalSoftening::least_factor);
  }
  EXPECT_FALSE(ThermalSoftening{}.heats());
  EXPECT_EQ(ThermalSoftening::of(steel_heating, 7850.0).heating, 0.9 / (7850.0 * 477.0));
}

TEST(rate_dependence, of_cowper_and_symonds_doubles_the_yield_stress_at_its_rate) {
  for (const double exponent : {1.0, 5.0, 100.0}) {
    const RateDependence rate{0.0, 40.4, 1.0 / exponent, 0.0};
    EXPECT_EQ(rate.factor(0.0), 1.0);
    EXPECT_NEAR(rate.factor(1.0), 2.0, 1e-11);
    for (const double ratio : {1e-8, 0.3, 7.0, 1e6}) {
      EXPECT_NEAR(rate.factor(ratio * ratio), 1.0 + std::pow(ratio, 1.0 / exponent),
                  1e-11 * (1.0 + std::pow(ratio, 1.0 / exponent)));
    }
  }
  EXPECT_EQ((RateDependence{}.factor(1e20)), 1.0) << "no law of the rate";
}

/// Through the law, in pure shear, whose effective rate is gxy/sqrt(3).
TEST(rate_dependence, of_cowper_and_symonds_goes_with_any_hardening) {
  J2Linear mild{{7850.0, 200e9, 0.3}, 250e6, 2e9};
  mild.cowper_symonds = CowperSymonds{40.4, 5.0};
  J2Table table{{7850.0, 200e9, 0.3}, {}};
  table.table.append({0.0, 250e6});
  table.cowper_symonds = mild.cowper_symonds;
  for (const double rate : {1e-6, 40.4, 2000.0}) {
    const auto check = [&](auto driver) {
      driver.stretch({0.0, 0.0, std::sqrt(3.0) * rate * 0.1 / rate}, 0.1 / rate);
      EXPECT_NEAR(test::von_mises(driver.point) / driver.yield_stress(), 1.0 + std::pow(rate / 40.4, 0.2), 1e-9);
    };
    check(test::PointDriver<J2Linear>(mild));
    check(test::PointDriver<J2Table>(table));
  }
}

TEST(rate_dependence, filter_takes_up_what_an_exponential_does) {
  RateDependence rate;
  EXPECT_FALSE(rate.filters());
  rate.cutoff = 5000.0;
  EXPECT_TRUE(rate.filters());
  for (const double x : {1e-12, 1e-3, 0.0199, 0.0201, 1.0, 30.0}) {
    const double weight = rate.filter_weight(x / (2.0 * std::numbers::pi * 5000.0));
    EXPECT_NEAR(weight, -std::expm1(-x), 2e-11 * weight + 1e-12 * (x > 0.02 ? 1.0 : 0.0)) << x;
  }
  EXPECT_EQ(rate.filter_weight(1e9), 1.0);
  EXPECT_EQ(rate.filter_weight(0.0), 0.0);
}

/// Whatever the steps are: after a time t of a constant rate r the filter has r (1 - exp(-2 pi f t)).
TEST(rate_dependence, filtered_rate_of_a_jump_does_not_depend_on_the_steps) {
  J2Linear law{{7850.0, 200e9, 0.3, 0.02, 1e-3}, 250e6, 2e9};
  law.rate_cutoff = 2000.0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> decade(-8.0, -4.0);
  test::PointDriver<J2Linear> driver(law);
  double time = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double dt = std::pow(10.0, decade(random)), rate = 300.0;
    driver.stretch({0.0, 0.0, std::sqrt(3.0) * rate * dt}, dt);
    time += dt;
    EXPECT_NEAR(driver.conditions.rate, -rate * std::expm1(-2.0 * std::numbers::pi * 2000.0 * time), 1e-9 * rate);
  }
  EXPECT_GT(time, 1e-4);
}

/// Laws, filters and temperatures at random, held against a twin that is written with the functions of the C library:
/// the stress is on the yield surface of the temperature at the step's start or within it.
template <class Law>
void expect_conditions_hold(const Law& law, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0), decade(-5.0, -1.0), fast(-9.0, -5.0);
  int yielded = 0, elastic = 0;
  for (int path = 0; path < 40; ++path) {
    test::PointDriver<Law> driver(law);
    double rate = 0.0, temperature = law.heating ? law.heating->initial_temperature : 0.0;
    for (int i = 0; i < 80; ++i) {
      const double size = std::pow(10.0, decade(random)), dt = std::pow(10.0, fast(random));
      const std::array<double, 3> e{size * unit(random), size * unit(random), size * unit(random)};
      const double now = std::sqrt(4.0 / 3.0 * (e[0] * e[0] + e[0] * e[1] + e[1] * e[1] + e[2] * e[2] / 4.0)) / dt;
      rate = law.rate_cutoff > 0.0 ? rate - std::expm1(-2.0 * std::numbers::pi * law.rate_cutoff * dt) * (now - rate)
                                   : now;
      const double c = law.cowper_symonds
                           ? std::pow(rate / law.cowper_symonds->rate, 1.0 / law.cowper_symonds->exponent)
                           : law.rate_sensitivity * std::log(std::max(rate / law.reference_rate, 1.0));
      const double factor = (1.0 + c) * (law.heating ? softening(*law.heating, temperature) : 1.0);
      const double strain = driver.point.strain;
      const PointChange<double> change = driver.stretch(e, dt);
      const double q = test::von_mises(driver.point), yield = factor * driver.yield_stress();
      if (driver.point.strain > strain) {
        ++yielded;
        ASSERT_NEAR(q, yield, 2e-9 * yield) << "step " << i << " of path " << path << " at " << temperature;
      } else {
        ++elastic;
        ASSERT_LE(q, yield * (1.0 + 1e-9));
        ASSERT_EQ(change.plastic_work, 0.0);
      }
      if (law.heating) {
        const double heating = law.heating->fraction / (law.density * law.heating->specific_heat);
        temperature += heating * q * (driver.point.strain - strain);
        ASSERT_NEAR(driver.conditions.temperature, temperature, 1e-8 * std::abs(temperature));
        temperature = driver.conditions.temperature;
      }
      if (law.rate_cutoff > 0.0) {
        ASSERT_NEAR(driver.conditions.rate, rate, 1e-9 * rate);
        rate = driver.conditions.rate;
      }
    }
  }
  EXPECT_GT(yielded, 500);
  EXPECT_GT(elastic, 20);
}

TEST(yield_conditions, random_paths_follow_the_twin) {
  expect_conditions_hold(hot_steel(), 1);
  JohnsonCook filtered = hot_steel();
  filtered.rate_cutoff = 1e4;
  expect_conditions_hold(filtered, 2);
  J2Linear linear{{7850.0, 200e9, 0.3}, 250e6, 0.0};
  linear.heating = AdiabaticHeating{50.0, 600.0, 300.0, 250.0, 0.5, 1.0};
  linear.cowper_symonds = CowperSymonds{40.4, 5.0};
  linear.rate_cutoff = 300.0;
  expect_conditions_hold(linear, 3);
  J2Table table{{7850.0, 200e9, 0.3, 0.05, 10.0}, {}};
  table.table.append({0.0, 1e6});
  table.table.append({1e-6, 900e6});
  table.table.append({0.5, 901e6});
  table.table.append({0.501, 5e9});
  table.heating = AdiabaticHeating{477.0, 1793.0, 293.0, 1500.0, 2.0, 0.5};
  expect_conditions_hold(table, 4);
}

/// Sheared without end the metal nears its melting point and carries nothing: no step of any size stays in the return
/// for ever, overshoots by more than its own heat or makes a number that is none.
TEST(adiabatic_heating, a_metal_that_melts_is_followed_to_the_end) {
  for (const double shear : {1e-4, 0.01, 1.0, 50.0}) {
    AdiabaticHeating h = steel_heating;
    h.specific_heat = 5.0;  // Melts at a small strain
    test::PointDriver<JohnsonCook> driver(hot_steel(h));
    double last = h.initial_temperature;
    for (int i = 0; i < 6000; ++i) {
      driver.stretch({0.1 * shear, -0.05 * shear, shear}, 1e-6);
      ASSERT_TRUE(std::isfinite(driver.point.stress.shear) && std::isfinite(driver.conditions.temperature));
      ASSERT_GE(driver.conditions.temperature, last);
      last = driver.conditions.temperature;
    }
    EXPECT_GT(last, 1600.0) << shear;
    EXPECT_LT(test::von_mises(driver.point), 0.2 * driver.yield_stress()) << shear;
  }
}

TEST(adiabatic_heating, with_no_part_of_the_work_the_temperature_stays) {
  AdiabaticHeating h = steel_heating;
  h.fraction = 0.0;
  h.initial_temperature = 1043.0;
  test::PointDriver<JohnsonCook> driver(hot_steel(h));
  for (int i = 0; i < 100; ++i) {
    driver.stretch({0.0, 0.0, 1e-3}, 1e-3);
  }
  EXPECT_EQ(driver.conditions.temperature, 1043.0);
  EXPECT_GT(driver.point.strain, 0.04);
  EXPECT_NEAR(test::von_mises(driver.point), driver.yield_stress() * softening(h, 1043.0),
              1e-9 * driver.yield_stress());
}

/// Rows of temperature and rate stand behind those of all points, and every row belongs to one thing.
TEST(layered_section, has_rows_for_what_its_points_remember) {
  for (const bool heats : {false, true}) {
    for (const bool filters : {false, true}) {
      J2Linear law{{7850.0, 200e9, 0.3, 0.02, 1.0}, 250e6, 2e9};
      law.heating = heats ? std::optional(steel_heating) : std::nullopt;
      law.rate_cutoff = filters ? 100.0 : 0.0;
      const LayeredSection section = test::layered_section(law, 3);
      EXPECT_EQ(section.has_conditions(), heats || filters);
      EXPECT_EQ(section.rows(), layer_points + 3 * (point_rows + int{heats} + int{filters}));
      std::set<int> rows;
      for (int p = 0; p < 3; ++p) {
        if (heats) {
          rows.insert(section.temperature_row(p));
        }
        if (filters) {
          rows.insert(section.rate_row(p));
        }
      }
      EXPECT_EQ(rows.size(), 3 * (std::size_t{heats} + std::size_t{filters}));
      EXPECT_TRUE(rows.empty() || (*rows.begin() == layer_points + 3 * point_rows && *rows.rbegin() < section.rows()));
    }
  }
  EXPECT_EQ(LayeredSection{}.rows(), 0);
}

/// Bent, the outer points heat and those in the middle do not; the work of all is what is dissipated.
TEST(layered_shell, heats_where_it_yields) {
  J2Linear law{{7850.0, 200e9, 0.3}, 250e6, 0.0};
  law.heating = AdiabaticHeating{477.0, 1793.0, 293.0, 293.0, 1.0, 1.0};
  test::LayeredDriver<J2Linear> element(law, 0.01, 5);
  for (int i = 0; i < 100; ++i) {
    element.step({0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0, {}});
  }
  const ThroughThickness rule = through_thickness(Quadrature::gauss, 5);
  double heat = 0.0;
  for (int p = 0; p < 5; ++p) {
    const double rise = element.row(element.section().temperature_row(p)) - 293.0;
    EXPECT_EQ(rise > 0.0, p != 2) << p;
    heat += rule.weight[static_cast<std::size_t>(p)] * rise * 7850.0 * 477.0 * 0.01;
  }
  EXPECT_NEAR(heat, element.row(layer_dissipation), 1e-4 * heat) << "to the change of thickness";
}

/// Points that have failed keep their temperature and have no rate, not even where the strain is no number.
TEST(layered_shell, failed_points_neither_heat_nor_have_a_rate) {
  J2Linear law{{7850.0, 200e9, 0.3, 0.02, 1.0, 0.02}, 250e6, 2e9};
  law.heating = steel_heating;
  law.rate_cutoff = 10.0;
  test::LayeredDriver<J2Linear> element(law, 0.01, 2);
  const auto pull = [&](double strain) {
    element.step({strain, -0.3 * strain, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {}}, 1e-3);
  };
  for (int i = 0; i < 300 && element.row(layer_deleted) == 0.0; ++i) {
    EXPECT_EQ(element.row(element.section().rate_row(0)) > 0.0, i > 0);
    pull(2e-4);
  }
  ASSERT_EQ(element.row(layer_deleted), 1.0);
  const double temperature = element.row(element.section().temperature_row(1));
  EXPECT_GT(temperature, 300.0);
  for (const double strain : {0.3, std::numeric_limits<double>::quiet_NaN()}) {
    pull(strain);
    EXPECT_EQ(element.row(element.section().temperature_row(1)), temperature);
    EXPECT_EQ(element.row(element.section().rate_row(1)), 0.0);
  }
}

}  // namespace
}  // namespace fexp::physics
