// SPDX-License-Identifier: Apache-2.0
#include "solve/rigid_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "model/principal_axes.hpp"

namespace fexp::solve {
namespace {

using model::RigidBody;
using model::RigidMotion;

TEST(quaternion, turns_as_rodrigues_formula_does) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    const Vec3d axis{number(random), number(random), number(random)}, x{number(random), number(random), number(random)};
    const double angle = 0.2 * std::abs(number(random));
    const Vec3d e = (1.0 / norm(axis)) * axis;
    const Quaternion q = unit(rotation_by(angle * e));
    const Vec3d exact = std::cos(angle) * x + std::sin(angle) * cross(e, x) + (1.0 - std::cos(angle)) * dot(e, x) * e;
    EXPECT_NEAR(norm(rotated(q, x) - exact), 0.0, 2e-10);
    EXPECT_NEAR(norm(rotated(inverse(q), rotated(q, x)) - x), 0.0, 1e-15);
    const Quaternion other = unit(rotation_by(x));
    EXPECT_NEAR(norm(rotated(other * q, x) - rotated(other, rotated(q, x))), 0.0, 1e-15) << "q first, then the other";
  }
  EXPECT_EQ(rotated(Quaternion{}, {1.0, 2.0, 3.0}), (Vec3d{1.0, 2.0, 3.0}));
}

TEST(principal_axes, of_a_diagonal_matrix_are_those_of_the_model_in_ascending_order) {
  const model::PrincipalAxes axes = model::principal_axes({3.0, 1.0, 2.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(axes.value, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(axes.axis[0], (Vec3d{0.0, 1.0, 0.0}));
  EXPECT_EQ(axes.axis[1], (Vec3d{0.0, 0.0, 1.0}));
  EXPECT_EQ(axes.axis[2], (Vec3d{1.0, 0.0, 0.0}));
}

TEST(principal_axes, give_the_matrix_back) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    std::array<double, 6> m{};
    for (double& x : m) {
      x = number(random);
    }
    if (i % 3 == 0) {
      m = {2.0, 2.0, 2.0 + 1.0e-14 * m[2], 1.0e-15 * m[3], 0.0, 1.0e-15};  // A sphere, but for rounding
    }
    const model::PrincipalAxes axes = model::principal_axes(m);
    std::array<double, 6> sum{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& e = axes.axis[k];
      const std::array<double, 6> part{e.x * e.x, e.y * e.y, e.z * e.z, e.x * e.y, e.y * e.z, e.z * e.x};
      for (std::size_t j = 0; j < 6; ++j) {
        sum[j] += axes.value[k] * part[j];
      }
      EXPECT_NEAR(norm(e), 1.0, 1e-14);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_NEAR(sum[j], m[j], 1e-14);
    }
    EXPECT_NEAR(dot(cross(axes.axis[0], axes.axis[1]), axes.axis[2]), 1.0, 1e-14);
    EXPECT_LE(axes.value[0], axes.value[1]);
    EXPECT_LE(axes.value[1], axes.value[2]);
  }
}

RigidBody top() {
  RigidBody body;
  body.mass = 2.0;
  body.inertia = {1.0, 2.0, 2.7};
  const double c = 0.6, s = 0.8;
  body.axis = {Vec3d{c, s, 0.0}, Vec3d{-s, c, 0.0}, Vec3d{0.0, 0.0, 1.0}};
  return body;
}

RigidMotion spinning(const RigidBody& body, const Vec3d& rate) {
  RigidMotion motion;
  motion.angular_momentum = inertia_times(body, rate);
  return motion;
}

RigidHalf half_step(HalfStep half, double half_dt, double damping = 0.0) { return {half, half_dt, half_dt, damping}; }

TEST(rigid_body, that_turns_freely_keeps_its_angular_momentum_to_the_bit_and_its_energy_without_drift) {
  const model::Model model;
  const RigidBody body = top();
  const auto largest_error = [&](double dt, int steps, int from) {
    RigidMotion motion = spinning(body, {0.3, 1.0, 0.2});
    const Vec3d momentum = motion.angular_momentum;
    const double energy = rotation_energy(body, motion);
    double largest = 0.0;
    RigidBooks books;
    for (int i = 0; i < steps; ++i) {
      static_cast<void>(drift(model, body, half_step(HalfStep::opening, 0.5 * dt), motion, books));
      if (i >= from) {
        largest = std::max(largest, std::abs(rotation_energy(body, motion) / energy - 1.0));
      }
    }
    EXPECT_EQ(motion.angular_momentum, momentum);
    EXPECT_EQ(books.angular_impulse, (Vec3d{}));
    return largest;
  };
  const double early = largest_error(0.05, 2000, 0), late = largest_error(0.05, 40000, 38000);
  EXPECT_LT(early, 2e-4);
  EXPECT_LT(late, 1.05 * early);
  EXPECT_NEAR(early / largest_error(0.025, 4000, 0), 4.0, 0.1);
}

TEST(rigid_body, of_three_equal_moments_turns_about_its_angular_momentum) {
  const model::Model model;
  RigidBody body = top();
  body.inertia = {2.0, 2.0, 2.0};
  const Vec3d rate{0.3, -0.5, 1.0};
  RigidMotion motion = spinning(body, rate);
  RigidBooks books;
  for (int i = 0; i < 100; ++i) {
    const Vec3d mean = drift(model, body, half_step(HalfStep::opening, 0.05), motion, books);
    EXPECT_NEAR(norm(mean - rate), 0.0, 1e-14);
  }
  const double angle = 10.0 * norm(rate);
  const Vec3d e = (1.0 / norm(rate)) * rate, x{1.0, 2.0, 3.0};
  const Vec3d exact = std::cos(angle) * x + std::sin(angle) * cross(e, x) + (1.0 - std::cos(angle)) * dot(e, x) * e;
  EXPECT_NEAR(norm(rotated(motion.orientation, x) - exact), 0.0, 1e-8);
}

TEST(rigid_body, does_not_turn_about_axes_that_are_held) {
  const model::Model model;
  for (const int held : {1, 2, 3}) {
    RigidBody body = top();
    for (int i = 0; i < held; ++i) {
      body.held_rotations.push_back(i == 0 ? Vec3d{1, 0, 0} : i == 1 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1});
    }
    body.turns_freely = false;
    RigidMotion motion;
    motion.moment = {0.4, -0.2, 0.3};
    RigidBooks books;
    const double dt = 0.01;
    for (int i = 0; i < 100; ++i) {
      kick_rigid(model, body, half_step(HalfStep::opening, 0.5 * dt), motion, books);
      const Vec3d mean = drift(model, body, half_step(HalfStep::opening, 0.5 * dt), motion, books);
      kick_rigid(model, body, half_step(HalfStep::closing, 0.5 * dt), motion, books);
      hold_rotation(model, body, half_step(HalfStep::closing, 0.5 * dt), motion, books);
      EXPECT_EQ(mean.x, 0.0);
      EXPECT_TRUE(held < 2 || mean.y == 0.0);
      EXPECT_TRUE(held < 3 || mean.z == 0.0);
      const Vec3d alpha = angular_acceleration(body, motion, rotation_rate(body, motion));
      EXPECT_EQ(alpha.x, 0.0);
    }
    // What the moment has given and what the bearings took is what there is.
    EXPECT_NEAR(norm(motion.angular_momentum - (motion.moment + books.angular_impulse)), 0.0, 1e-14);
    EXPECT_EQ(books.work, 0.0);
    if (held == 2) {
      EXPECT_NEAR(rotation_rate(body, motion).z, 0.3 / 2.7, 1e-14) << "about the third principal axis";
    }
    if (held == 3) {
      EXPECT_EQ(motion.orientation, Quaternion{});
    }
  }
}

TEST(rigid_body, gives_damping_what_it_loses) {
  const model::Model model;
  const RigidBody body = top();
  RigidMotion motion = spinning(body, {0.1, 0.2, 1.0});
  motion.velocity = {1.0, 0.0, 2.0};
  motion.centre = {0.0, 3.0, 0.0};
  const double before = rotation_energy(body, motion) + 0.5 * body.mass * 5.0;
  const Vec3d momentum = motion.angular_momentum + cross(motion.centre, body.mass * motion.velocity);
  RigidBooks books;
  kick_rigid(model, body, half_step(HalfStep::opening, 0.1, 0.5), motion, books);
  EXPECT_NEAR(motion.velocity.x, 1.0 / 1.05, 1e-15);
  const double after = rotation_energy(body, motion) + 0.5 * body.mass * dot(motion.velocity, motion.velocity);
  EXPECT_NEAR(books.damping_work, before - after, 1e-14);
  EXPECT_NEAR(norm(motion.angular_momentum + cross(motion.centre, body.mass * motion.velocity) - momentum -
                   books.angular_impulse),
              0.0, 1e-14);
}

}  // namespace
}  // namespace fexp::solve
