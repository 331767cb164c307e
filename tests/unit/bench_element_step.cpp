// SPDX-License-Identifier: Apache-2.0
#include "bench/element_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/aligned_vector.hpp"
#include "bench/rate.hpp"
#include "bench/scenes.hpp"
#include "model/state.hpp"
#include "solve/kernels.hpp"

namespace {

using fexp::Vec3;
using fexp::Vec3d;
using fexp::bench::Counted;
using fexp::bench::OperationCount;
namespace bench = fexp::bench;
namespace model = fexp::model;
namespace physics = fexp::physics;
namespace solve = fexp::solve;

constexpr double dt = 1.0e-3;

const physics::ShellStiffness& stiffness() {
  static const physics::ShellStiffness made(physics::ShellSection{0.02, {1.1, 0.33, 0.385}, 0.1});
  return made;
}

bench::TriangleMotion<double> some_motion() {
  bench::TriangleMotion<double> m{};
  m.position = {{{0.1, 0.2, 0.3}, {1.2, 0.1, 0.4}, {0.3, 0.9, -0.2}}};
  m.velocity = {{{1.0, -2.0, 3.0}, {0.5, 0.25, -1.5}, {-3.0, 1.0, 2.0}}};
  m.rotation_rate = {{{0.3, 0.2, -0.1}, {-0.7, 0.4, 0.6}, {0.9, -0.8, 0.5}}};
  m.resultants = {1.0, -2.0, 0.5, 0.1, 0.2, -0.3, 0.7, -0.6, {0.01, 0.02, -0.03}, 4.0};
  return m;
}

template <std::size_t N>
std::array<Vec3<Counted>, N> counted(const std::array<Vec3d, N>& all) {
  std::array<Vec3<Counted>, N> made;
  for (std::size_t i = 0; i < N; ++i) {
    made[i] = {all[i].x, all[i].y, all[i].z};
  }
  return made;
}

/// What is counted is what the kernel does: both give the same bits.
TEST(BenchElementStep, FollowsTheElementKernel) {
  bench::TriangleMotion<double> m = some_motion();
  std::array<model::NodeMotion, 3> nodes;
  for (std::size_t i = 0; i < 3; ++i) {
    nodes[i] = {m.position[i], m.velocity[i], m.rotation_rate[i]};
  }
  const physics::ShellResultants<double>& s = m.resultants;
  const std::array<double, model::element_rows> rows{s.nxx, s.nyy, s.nxy,      s.mxx,      s.myy,      s.mxy,
                                                     s.qxz, s.qyz, s.drill[0], s.drill[1], s.drill[2], s.energy};
  fexp::AlignedVector<double> history(fexp::at(model::element_rows * model::block_lanes));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    history[r * fexp::at(model::block_lanes)] = rows[r];
  }
  const std::array<fexp::Index, 3> triangle{0, 1, 2};
  const model::ElementBlock block{0, 1, 0, 0};
  const std::array<std::uint16_t, 3> place{0, 1, 2};
  std::array<solve::NodeForce, 3> corner{};
  const solve::ElementKernelArguments arguments{nodes.data(),   &triangle,    &block,        &stiffness(),
                                                history.data(), place.data(), corner.data(), dt};
  solve::select_element_kernel(solve::KernelChoice::scalar).elements(arguments, 0, 1);

  const bench::CornerActions<double> actions = bench::step_element(stiffness(), m, dt);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(actions.force[i], corner[i].force);
    EXPECT_EQ(actions.moment[i], corner[i].moment);
  }
  EXPECT_EQ(m.resultants.nxx, history[0]);
  EXPECT_EQ(m.resultants.energy, history[fexp::at(model::row_energy * model::block_lanes)]);
}

TEST(BenchElementStep, CountedNumbersHaveTheValuesOfDoubles) {
  bench::TriangleMotion<double> m = some_motion();
  bench::TriangleMotion<Counted> c{};
  c.position = counted(m.position);
  c.velocity = counted(m.velocity);
  c.rotation_rate = counted(m.rotation_rate);
  const physics::ShellResultants<double>& s = m.resultants;
  c.resultants = {s.nxx,   s.nyy, s.nxy, s.mxx, s.myy, s.mxy, s.qxz, s.qyz, {s.drill[0], s.drill[1], s.drill[2]},
                  s.energy};
  const bench::CornerActions<double> expected = bench::step_element(stiffness(), m, dt);
  const bench::CornerActions<Counted> actions = bench::step_element(stiffness(), c, Counted(dt));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(actions.force[i].x.value(), expected.force[i].x);
    EXPECT_EQ(actions.moment[i].z.value(), expected.moment[i].z);
  }
}

/// By hand, from the formulas of the frame: two cross products of 6 products and 3 sums, three scalar products of 3 and
/// 2, two roots, a division, and ten products more.
TEST(BenchElementStep, CountsTheOperationsOfAFrame) {
  const OperationCount count = bench::count_operations([] {
    const Vec3<Counted> a{1.0, 0.0, 0.0}, b{0.0, 1.0, 0.0};
    static_cast<void>(physics::triangle_frame(a, b));
  });
  EXPECT_EQ(count.additions, 2 * 3 + 3 * 2);
  EXPECT_EQ(count.multiplications, 2 * 6 + 3 * 3 + 1 + 2 + 6 + 1);
  EXPECT_EQ(count.divisions, 1);
  EXPECT_EQ(count.square_roots, 2);
}

TEST(BenchElementStep, NodesOfASphereAreHalfAsManyAsItsTriangles) {
  const model::Model sphere = bench::sphere(768);
  const bench::ElementStepCost cost = bench::element_step_cost(sphere);
  EXPECT_DOUBLE_EQ(cost.nodes, (0.5 * 768.0 + 2.0) / 768.0);
  EXPECT_DOUBLE_EQ(cost.flops(),
                   static_cast<double>(cost.element.flops()) + cost.nodes * static_cast<double>(cost.node.flops()));
}

/// The example's own numbers, and the same shape of things where the mesh is finer.
TEST(BenchScenes, FourSpheresAreThoseOfTheExample) {
  const model::Model example = bench::four_spheres(4), finer = bench::four_spheres(16);
  EXPECT_EQ(example.element_count(), 768);
  EXPECT_EQ(finer.element_count(), 12'288);
  EXPECT_EQ(example.sections.front().thickness, 0.01);
  EXPECT_EQ(finer.sections.front().thickness, 0.0025);
  EXPECT_EQ(example.run.duration, 0.02);
  const auto lowest_x = [](const model::Model& m, std::size_t body) {
    double low = HUGE_VAL;
    for (fexp::Index n = m.bodies[body].nodes.begin; n < m.bodies[body].nodes.end; ++n) {
      low = std::min(low, m.reference_position[fexp::at(n)].x);
    }
    return low;
  };
  EXPECT_DOUBLE_EQ(lowest_x(example, 1), 0.6);
  EXPECT_DOUBLE_EQ(lowest_x(example, 3), 0.615);
  EXPECT_DOUBLE_EQ(lowest_x(finer, 1), 0.525);
  // As many steps, within what the elements' shapes change.
  const double steps = example.run.duration / example.first_critical_step;
  EXPECT_NEAR(finer.run.duration / finer.first_critical_step / steps, 1.0, 0.35);
}

TEST(BenchRate, MedianBestAndSpread) {
  const bench::Rate rate = bench::rate_of({3.0, 1.0, 2.0});
  EXPECT_EQ(rate.median, 2.0);
  EXPECT_EQ(rate.best, 3.0);
  EXPECT_EQ(rate.spread, 1.0);
}

}  // namespace
