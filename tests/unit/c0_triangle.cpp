// SPDX-License-Identifier: Apache-2.0
#include "physics/c0_triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "physics/linear_elastic.hpp"

namespace fexp::physics {
namespace {

using Corners = std::array<Vec3d, 3>;

const ShellSection section{0.01, LinearElastic{1.0, 1000.0, 0.3}.moduli(), 0.1};

/// Strain increments and resultants at random, increments of size `strain`.
class RandomStates {
 public:
  ShellIncrement<double> increment(double strain) {
    const auto value = [&] { return strain * unit_(random_); };
    return {value(), value(), value(), value(), value(), value(), value(), value(), {value(), value(), value()}};
  }
  ShellResultants<double> resultants() {
    const auto value = [&] { return unit_(random_); };
    return {value(), value(), value(), value(), value(), value(), value(), value(), {value(), value(), value()}, 0.0};
  }
  Vec3d vector() { return {unit_(random_), unit_(random_), unit_(random_)}; }

 private:
  std::mt19937 random_{4};
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
};

ShellIncrement<double> reversed(const ShellIncrement<double>& e) {
  return {-e.exx, -e.eyy, -e.gxy, -e.kxx, -e.kyy, -e.kxy, -e.gxz, -e.gyz, {-e.drill[0], -e.drill[1], -e.drill[2]}};
}

/// Largest difference of any resultant.
double difference(const ShellResultants<double>& a, const ShellResultants<double>& b) {
  double largest = 0.0;
  for (const double d :
       {a.nxx - b.nxx, a.nyy - b.nyy, a.nxy - b.nxy, a.mxx - b.mxx, a.myy - b.myy, a.mxy - b.mxy, a.qxz - b.qxz,
        a.qyz - b.qyz, a.drill[0] - b.drill[0], a.drill[1] - b.drill[1], a.drill[2] - b.drill[2]}) {
    largest = std::max(largest, std::abs(d));
  }
  return largest;
}

TEST(linear_elastic, in_uniaxial_strain_and_shear_has_the_plane_stress_moduli) {
  const PlaneStressModuli m = LinearElastic{1.0, 91.0, 0.3}.moduli();
  EXPECT_NEAR(m.direct, 100.0, 1e-12);
  EXPECT_NEAR(m.cross, 30.0, 1e-12);
  EXPECT_NEAR(m.shear, 35.0, 1e-12);
}

TEST(update_elastic, of_a_stretch_without_shear_is_hookes_law) {
  ShellResultants<double> r{};
  update_elastic(section, 2.0, {1e-3, -2e-3, 0.0, 3e-3, 1e-3, 0.0, 4e-3, 5e-3, {}}, r);
  const double plane = 1000.0 / (1.0 - 0.09), bend = plane * 1e-6 / 12.0, shear = 5.0 / 6.0 * 0.01 * 1000.0 / 2.6;
  EXPECT_NEAR(r.nxx, 0.01 * plane * (1e-3 - 0.3 * 2e-3), 1e-15);
  EXPECT_NEAR(r.nyy, 0.01 * plane * (-2e-3 + 0.3 * 1e-3), 1e-15);
  EXPECT_NEAR(r.mxx, bend * (3e-3 + 0.3 * 1e-3), 1e-20);
  EXPECT_NEAR(r.myy, bend * (1e-3 + 0.3 * 3e-3), 1e-20);
  EXPECT_NEAR(r.qxz, shear * 4e-3, 1e-16);
  EXPECT_NEAR(r.qyz, shear * 5e-3, 1e-16);
  const double doubled = r.nxx * 1e-3 - r.nyy * 2e-3 + r.mxx * 3e-3 + r.myy * 1e-3 + r.qxz * 4e-3 + r.qyz * 5e-3;
  EXPECT_NEAR(r.energy, 2.0 * 0.5 * doubled, 1e-16);
}

TEST(update_elastic, comes_back_when_the_increment_is_reversed) {
  RandomStates states;
  for (int i = 0; i < 1000; ++i) {
    const ShellResultants<double> start = states.resultants();
    const ShellIncrement<double> e = states.increment(0.1);
    ShellResultants<double> r = start;
    update_elastic(section, 2.0, e, r);
    update_elastic(section, 2.0, reversed(e), r);
    EXPECT_LT(difference(r, start), 1e-14);
    EXPECT_NEAR(r.energy, 0.0, 1e-14);
  }
}

TEST(update_elastic, turns_resultants_without_changing_their_length_or_trace) {
  // No stiffness: what is left of the update is the turn.
  const ShellSection soft{0.01, {0.0, 0.0, 0.0}, 0.0};
  RandomStates states;
  for (int i = 0; i < 1000; ++i) {
    const ShellResultants<double> start = states.resultants();
    ShellResultants<double> r = start;
    const double shear = states.increment(0.2).gxy;
    update_elastic(soft, 1.0, {0, 0, shear, 0, 0, 0, 0, 0, {}}, r);
    const auto length = [](double xx, double yy, double xy) { return xx * xx + yy * yy + 2.0 * xy * xy; };
    EXPECT_NEAR(length(r.nxx, r.nyy, r.nxy), length(start.nxx, start.nyy, start.nxy), 1e-14);
    EXPECT_NEAR(length(r.mxx, r.myy, r.mxy), length(start.mxx, start.myy, start.mxy), 1e-14);
    EXPECT_NEAR(r.nxx + r.nyy, start.nxx + start.nyy, 1e-15);
    EXPECT_NEAR(r.qxz * r.qxz + r.qyz * r.qyz, start.qxz * start.qxz + start.qyz * start.qyz, 1e-14);
    // By -gxy/2 for small angles: a vector along x gets y = -gxy/2.
    ShellResultants<double> along{};
    along.qxz = 1.0;
    update_elastic(soft, 1.0, {0, 0, shear, 0, 0, 0, 0, 0, {}}, along);
    EXPECT_NEAR(std::atan2(along.qyz, along.qxz), -0.5 * shear, 1e-1 * std::abs(shear * shear * shear) + 1e-16);
  }
}

TEST(corner_forces, do_no_work_on_rigid_motion) {
  RandomStates states;
  for (int i = 0; i < 200; ++i) {
    const Corners x{states.vector(), states.vector(), states.vector()};
    const TriangleFrame<double> frame = triangle_frame(x[1] - x[0], x[2] - x[0]);
    Corners force, moment;
    corner_forces(section, frame, states.resultants(), force, moment);
    Vec3d sum, turning;
    double scale = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      sum += force[c];
      turning += cross(x[c], force[c]) + moment[c];
      scale += norm(force[c]) * (1.0 + norm(x[c])) + norm(moment[c]);
    }
    EXPECT_LT(norm(sum), 1e-14 * scale);
    EXPECT_LT(norm(turning), 1e-13 * scale);
  }
}

TEST(corner_forces, do_the_work_of_the_resultants_on_any_motion) {
  RandomStates states;
  for (int i = 0; i < 200; ++i) {
    const Corners x{states.vector(), states.vector(), states.vector()};
    const TriangleFrame<double> frame = triangle_frame(x[1] - x[0], x[2] - x[0]);
    const double area = 0.5 * frame.doubled_area;
    const Corners v{states.vector(), states.vector(), states.vector()};
    const Corners w{states.vector(), states.vector(), states.vector()};
    const ShellResultants<double> r = states.resultants();
    Corners force, moment;
    corner_forces(section, frame, r, force, moment);
    double outer = 0.0, scale = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      outer += dot(force[c], v[c]) + dot(moment[c], w[c]);
      scale += norm(force[c]) * norm(v[c]) + norm(moment[c]) * norm(w[c]);
    }
    // A step too short to turn anything: increments over it are rates.
    const double dt = 0x1p-60;
    const ShellIncrement<double> e = strain_increment(frame, v[1] - v[0], v[2] - v[0], w, dt);
    const double density = r.nxx * e.exx + r.nyy * e.eyy + r.nxy * e.gxy + r.mxx * e.kxx + r.myy * e.kyy +
                           r.mxy * e.kxy + r.qxz * e.gxz + r.qyz * e.gyz;
    double drill = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      drill += r.drill[c] * e.drill[c];
    }
    EXPECT_NEAR(outer, (area * density + drilling_stiffness(section, area) * drill) / dt, 1e-13 * scale);
  }
}

}  // namespace
}  // namespace fexp::physics
