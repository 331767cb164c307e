// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/models.hpp"
#include "support/verification_table.hpp"

namespace fexp {
namespace {

using std::numbers::pi;
using test::verify;

/// Moment at which a straight line through two samples takes a value.
double crossing(double value, double t0, double y0, double t1, double y1) {
  return t0 + (t1 - t0) * (value - y0) / (y1 - y0);
}

TEST(strip_wave, arrives_with_the_bar_velocity_and_doubles_at_the_fixed_end) {
  const double thickness = 0.1, pressure = 100.0;
  auto d = test::description({7.4e-4, 30.0e6, 0.0}, thickness);
  test::add_body(d, "strip", model::Plate{20.0, 1.0, 80, 4, "one"});
  test::add_box_set(d, "fixed end", {19.99, -1.0, -1.0}, {20.01, 2.0, 1.0});
  test::fix(d, "fixed end", {"x", "y", "z", "rx", "ry", "rz"});
  test::add_box_set(d, "inner", {-0.01, 0.01, -1.0}, {0.01, 0.99, 1.0});
  test::add_box_set(d, "lower corner", {-0.01, -0.01, -1.0}, {0.01, 0.01, 1.0});
  test::add_box_set(d, "upper corner", {-0.01, 0.99, -1.0}, {0.01, 1.01, 1.0});
  const double share = pressure * thickness / 4.0;
  d.forces.push_back({"inner", {share, 0, 0}, {}, false, "", {}});
  d.forces.push_back({"lower corner", {0.5 * share, 0, 0}, {}, false, "", {}});
  d.forces.push_back({"upper corner", {0.5 * share, 0, 0}, {}, false, "", {}});
  const model::Model model = test::build(d);
  test::DirectRun run(model);

  // Stress across the middle: the trace, which needs no axes, is sigma xx for nu = 0.
  const auto middle_stress = [&] {
    double sum = 0.0;
    int count = 0;
    for (Index e = 0; e < model.element_count(); ++e) {
      const auto& t = model.triangle[at(e)];
      double centre = 0.0;
      for (const Index n : t) {
        centre += model.reference_position[at(n)].x / 3.0;
      }
      if (std::abs(centre - 10.0) < 0.25) {
        sum += model::element_value(model, run.state, e, model::row_nxx) +
               model::element_value(model, run.state, e, model::row_nyy);
        ++count;
      }
    }
    return sum / (thickness * count);
  };
  const double dt = 0.5 * model.first_critical_step;
  double first = 0.0, second = 0.0, before = 0.0;
  double sums[2] = {0.0, 0.0};
  int counts[2] = {0, 0};
  while (run.state.time < 228e-6) {
    const double time = run.state.time;
    run.advance(dt, 1);
    const double now = middle_stress();
    if (first == 0.0 && now < -0.5 * pressure) {
      first = crossing(-0.5 * pressure, time, before, run.state.time, now);
    }
    if (second == 0.0 && now < -1.5 * pressure && run.state.time > 140e-6) {
      second = crossing(-1.5 * pressure, time, before, run.state.time, now);
    }
    before = now;
    for (int i = 0; i < 2; ++i) {
      if (run.state.time > (i == 0 ? 70e-6 : 170e-6) && run.state.time < (i == 0 ? 130e-6 : 228e-6)) {
        sums[i] += now;
        ++counts[i];
      }
    }
  }
  const std::string title = "strip wave, 80 x 4 cells";
  verify({"12", title, "arrival at the middle [us]", 49.67, 1e6 * first, 0.02, true, "10 / sqrt(E/rho)"});
  verify({"12", title, "arrival of the reflection [us]", 149.0, 1e6 * second, 0.02, true, "30 / sqrt(E/rho)"});
  verify({"12", title, "stress behind the front [psi]", -100.0, sums[0] / counts[0], 5e-3, true, "d'Alembert"});
  verify({"12", title, "stress behind the reflection [psi]", -200.0, sums[1] / counts[1], 5e-3, true, "d'Alembert"});
}

/// sin(m pi x) sin(n pi y) and its gradient.
struct Sines {
  int m, n;
  [[nodiscard]] double value(const Vec3d& p) const { return std::sin(m * pi * p.x) * std::sin(n * pi * p.y); }
  [[nodiscard]] double dx(const Vec3d& p) const { return m * pi * std::cos(m * pi * p.x) * std::sin(n * pi * p.y); }
  [[nodiscard]] double dy(const Vec3d& p) const { return n * pi * std::sin(m * pi * p.x) * std::cos(n * pi * p.y); }
};

/// w a^2 sqrt(rho h/D) of free vibration in the shape `a` + sign x `b` of a square simply supported plate, from the
/// second return to rest position: one period.
double plate_frequency(int cells, double h, const Sines& a, const Sines& b, double sign) {
  auto d = test::description({1.0, 1.0, 0.3}, h);
  test::add_body(d, "plate", model::Plate{1.0, 1.0, cells, cells, "one"});
  test::add_box_set(d, "left", {-0.001, -1, -1}, {0.001, 2, 1});
  test::add_box_set(d, "right", {0.999, -1, -1}, {1.001, 2, 1});
  test::add_box_set(d, "low", {-1, -0.001, -1}, {2, 0.001, 1});
  test::add_box_set(d, "high", {-1, 0.999, -1}, {2, 1.001, 1});
  for (const char* set : {"left", "right"}) {
    test::fix(d, set, {"z", "rx"});
  }
  for (const char* set : {"low", "high"}) {
    test::fix(d, set, {"z", "ry"});
  }
  model::Model model = test::build(d);
  const double speed = 1e-6 * h;
  std::vector<double> shape;
  for (std::size_t n = 0; n < model.reference_position.size(); ++n) {
    const Vec3d& x = model.reference_position[n];
    shape.push_back(a.value(x) + sign * b.value(x));
    model.initial_velocity[n].z = speed * shape.back();
    model.initial_rotation_rate[n] = {speed * (a.dy(x) + sign * b.dy(x)), -speed * (a.dx(x) + sign * b.dx(x)), 0.0};
  }
  test::DirectRun run(model);
  const double dt = 0.9 * model.first_critical_step;
  const double unit = std::sqrt(12.0 * (1.0 - 0.09)) / h;  // a^2 sqrt(rho h/D)
  const double expected = 2.0 * pi * unit / (pi * pi * (a.m * a.m + a.n * a.n));
  const auto stride = std::max(static_cast<Index>(expected / dt / 200.0), Index{1});
  double before = 0.0, time = 0.0;
  for (int returns = 0; run.state.time < 2.0 * expected;) {
    time = run.state.time;
    run.advance(dt, stride);
    double now = 0.0;
    for (std::size_t n = 0; n < shape.size(); ++n) {
      now += shape[n] * run.state.motion[n].position.z;
    }
    if (now * before < 0.0 && ++returns == 2) {
      return 2.0 * pi * unit / crossing(0.0, time, before, run.state.time, now);
    }
    before = now;
  }
  ADD_FAILURE() << "no full period";
  return 0.0;
}

TEST(simply_supported_plate, vibrates_with_the_frequencies_of_thin_plates) {
  const Sines none{0, 0};
  const std::string source = "pi^2 (m^2 + n^2), Kirchhoff";
  verify({"13", "plate h/a = .005, 16 cells", "lambda, mode 1 1", 19.7392,
          plate_frequency(16, 0.005, {1, 1}, none, 0.0), 7e-3, true, source});
  const std::string title = "plate h/a = .005, 32 cells";
  verify({"13", title, "lambda, mode 1 1", 19.7392, plate_frequency(32, 0.005, {1, 1}, none, 0.0), 1e-3, true, source});
  verify({"13", title, "lambda, mode 1 2 + 2 1", 49.348, plate_frequency(32, 0.005, {1, 2}, {2, 1}, 1.0), 1e-3, true,
          source});
  verify({"13", title, "lambda, mode 1 2 - 2 1", 49.348, plate_frequency(32, 0.005, {1, 2}, {2, 1}, -1.0), 1e-3, true,
          source});
  verify({"13", title, "lambda, mode 2 2", 78.957, plate_frequency(32, 0.005, {2, 2}, none, 0.0), 1e-3, true, source});
}

TEST(simply_supported_plate, vibrates_with_the_frequency_of_thick_plates) {
  verify({"13", "plate h/a = .1, 32 cells", "lambda, mode 1 1", 19.0650, plate_frequency(32, 0.1, {1, 1}, {0, 0}, 0.0),
          1e-3, true, "Mindlin, shear factor 5/6"});
}

TEST(cantilever, under_a_step_load_swings_to_the_known_peak) {
  for (const auto& [along, across] : {std::pair{5, 1}, std::pair{20, 2}}) {
    auto d = test::description({1.024e-6, 12000.0, 0.2}, 1.0);
    test::add_body(d, "beam", model::Plate{10.0, 1.0, along, across, "one"});
    test::add_box_set(d, "root", {-0.01, -1, -1}, {0.01, 2, 1});
    test::add_box_set(d, "tip", {9.99, -1, -1}, {10.01, 2, 1});
    test::fix(d, "root", {"x", "y", "z", "rx", "ry", "rz"});
    d.pressure.push_back({{"beam"}, "", 0.01, "", {}});
    const model::Model model = test::build(d);
    const std::vector<Index> tip = test::nodes_of(model, "tip");
    test::DirectRun run(model);
    double peak = 0.0;
    while (run.state.time < 6.0e-3) {
      run.advance(0.5 * model.first_critical_step, 1);
      double down = 0.0;
      for (const Index n : tip) {
        down -= run.state.motion[at(n)].position.z / static_cast<double>(tip.size());
      }
      peak = std::max(peak, down);
    }
    verify({"15", "cantilever, step load", fmt::format("peak tip deflection [in], {} x {}", along, across), 0.02532,
            peak, 0.01, true, "beam theory; LS-DYNA .02518"});
  }
}

}  // namespace
}  // namespace fexp
