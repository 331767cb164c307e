// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/pack.hpp"
#include "solve/kernels.hpp"

namespace fexp::solve::kernels {

/// The six components of a node's force and moment, or of its velocity and rotation rate, one by one.
struct SixNumbers {
  std::array<double, 6> v{};

  [[nodiscard]] static SixNumbers load(const double* p) noexcept { return {{p[0], p[1], p[2], p[3], p[4], p[5]}}; }
  [[nodiscard]] static SixNumbers load_three(const double* p) noexcept { return {{p[0], p[1], p[2], 0.0, 0.0, 0.0}}; }
  [[nodiscard]] static SixNumbers of(double linear, double angular) noexcept {
    return {{linear, linear, linear, angular, angular, angular}};
  }
  void store(double* p) const noexcept { std::memcpy(p, v.data(), sizeof(v)); }
  [[nodiscard]] double operator[](std::size_t i) const noexcept { return v[i]; }

  template <class Operation>
  [[nodiscard]] static SixNumbers each(const SixNumbers& a, const SixNumbers& b, const Operation& operation) noexcept {
    SixNumbers r;
    for (std::size_t i = 0; i < 6; ++i) {
      r.v[i] = operation(a.v[i], b.v[i]);
    }
    return r;
  }
  friend SixNumbers operator+(const SixNumbers& a, const SixNumbers& b) noexcept {
    return each(a, b, [](double x, double y) { return x + y; });
  }
  friend SixNumbers operator-(const SixNumbers& a, const SixNumbers& b) noexcept {
    return each(a, b, [](double x, double y) { return x - y; });
  }
  friend SixNumbers operator*(const SixNumbers& a, const SixNumbers& b) noexcept {
    return each(a, b, [](double x, double y) { return x * y; });
  }
};

/// The same in a pack of four and one of two, which every instruction set has in some way.
template <InstructionSet Set>
struct SixLanes {
  using Four = BasicPack<4, Set>;
  using Two = BasicPack<2, Set>;

  Four a;
  Two b;

  [[nodiscard]] static SixLanes load(const double* p) noexcept { return {Four::load(p), Two::load(p + 4)}; }
  [[nodiscard]] static SixLanes load_three(const double* p) noexcept {
    SixLanes r{Four(0.0), Two(0.0)};
    for (int i = 0; i < 3; ++i) {
      r.a.set_lane(i, p[i]);
    }
    return r;
  }
  [[nodiscard]] static SixLanes of(double linear, double angular) noexcept {
    SixLanes r{Four(linear), Two(angular)};
    r.a.set_lane(3, angular);
    return r;
  }
  void store(double* p) const noexcept {
    a.store(p);
    b.store(p + 4);
  }
  [[nodiscard]] double operator[](int i) const noexcept { return i < 4 ? a.lane(i) : b.lane(i - 4); }

  friend SixLanes operator+(const SixLanes& x, const SixLanes& y) noexcept { return {x.a + y.a, x.b + y.b}; }
  friend SixLanes operator-(const SixLanes& x, const SixLanes& y) noexcept { return {x.a - y.a, x.b - y.b}; }
  friend SixLanes operator*(const SixLanes& x, const SixLanes& y) noexcept { return {x.a * y.a, x.b * y.b}; }
};

/// Whether a running sum of x - x, which is zero as long as every x is finite, still is.
template <class Six>
[[nodiscard]] inline bool is_zero(const Six& sum) noexcept {
  return sum[0] == 0.0 && sum[1] == 0.0 && sum[2] == 0.0 && sum[3] == 0.0 && sum[4] == 0.0 && sum[5] == 0.0;
}

/// Nodes one by one: their forces summed in order, then as NodeKernel says.
template <class Six>
inline NodeKernelReport update_nodes(const NodeKernelArguments& k, const Index* nodes, Index begin,
                                     Index end) noexcept {
  const Six half = Six::of(k.half_dt, k.half_dt);
  const Six zero = Six::of(0.0, 0.0);
  Six closing_squares = zero, opening_squares = zero;
  double largest = 0.0;
  for (Index i = begin; i < end; ++i) {
    const Index node = nodes[i];
    Six internal = zero;
    const Index force_end = k.force_start == nullptr ? i - begin + 1 : k.force_start[i + 1];
    for (Index f = k.force_start == nullptr ? i - begin : k.force_start[i]; f < force_end; ++f) {
      internal = internal + Six::load(&k.force[f].force.x);
    }
    const Six outer = k.contact_force == nullptr ? zero : Six::load_three(&k.contact_force[node].x);
    const Six acceleration =
        Six::of(k.inverse_inertia[node].mass, k.inverse_inertia[node].inertia) * (outer - internal);

    model::NodeMotion& motion = k.motion[node];
    Six rates = Six::load(&motion.velocity.x) + half * acceleration;
    Six squares = rates * rates;
    closing_squares = closing_squares + (squares - squares);
    if (k.go_on) {
      rates = rates + half * acceleration;
      squares = rates * rates;
      opening_squares = opening_squares + (squares - squares);
      const double speed2 = squares[0] + squares[1] + squares[2];
      largest = speed2 > largest ? speed2 : largest;
      motion.position.x += k.dt * rates[0];
      motion.position.y += k.dt * rates[1];
      motion.position.z += k.dt * rates[2];
    } else {
      acceleration.store(&k.acceleration[node].linear.x);
    }
    rates.store(&motion.velocity.x);
  }
  return {largest, is_zero(closing_squares), is_zero(opening_squares)};
}

NodeKernelReport update_nodes_scalar(const NodeKernelArguments& k, const Index* nodes, Index begin, Index end) noexcept;
NodeKernelReport update_nodes_baseline(const NodeKernelArguments& k, const Index* nodes, Index begin,
                                       Index end) noexcept;
NodeKernelReport update_nodes_avx2(const NodeKernelArguments& k, const Index* nodes, Index begin, Index end) noexcept;
NodeKernelReport update_nodes_avx512(const NodeKernelArguments& k, const Index* nodes, Index begin, Index end) noexcept;

}  // namespace fexp::solve::kernels
