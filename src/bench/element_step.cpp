// SPDX-License-Identifier: Apache-2.0
#include "bench/element_step.hpp"

#include <array>

#include "model/state.hpp"
#include "solve/kernels.hpp"

namespace fexp::bench {

namespace {

constexpr double history_bytes = model::element_rows * sizeof(double);
constexpr double motion_bytes = sizeof(model::NodeMotion);
constexpr double inverse_bytes = sizeof(solve::InverseInertia);
constexpr double corners_bytes = sizeof(std::array<Index, 3>);

OperationCount count_element() {
  // Any section and motion will do: there are no branches.
  const physics::ShellStiffness stiffness(physics::ShellSection{0.01, {1.0, 0.3, 0.35}, 0.1});
  OperationCount count = count_operations([&] {
    TriangleMotion<Counted> motion{};
    motion.position = {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
    static_cast<void>(step_element<Counted>(stiffness, motion, 1.0e-3));
  });
  // The product of half the step is taken once for all.
  count.multiplications -= 1;
  // Three components of force and of moment of three corners.
  count.additions += 18;
  return count;
}

/// What the node kernel does where nothing touches; its checks that all numbers are finite are left out.
OperationCount count_node() {
  return count_operations([] {
    const Counted inverse(1.0), half_dt(0.5), dt(1.0);
    const auto component = [&](Counted& position, Counted& rate, const Counted& internal, bool moves) {
      const Counted acceleration = inverse * -internal;
      rate = rate + half_dt * acceleration;  // Closes this step
      rate = rate + half_dt * acceleration;  // Opens the next one
      if (moves) {
        position = position + dt * rate;
      }
    };
    Counted position(0.0), rate(0.0);
    for (int i = 0; i < 6; ++i) {
      component(position, rate, Counted(1.0), i < 3);
    }
  });
}

}  // namespace

double ElementStepCost::least_bytes() const noexcept {
  return 2.0 * history_bytes + corners_bytes + nodes * (2.0 * motion_bytes + inverse_bytes);
}

double ElementStepCost::least_memory() const noexcept {
  return history_bytes + corners_bytes + nodes * (motion_bytes + inverse_bytes);
}

ElementStepCost element_step_cost(const model::Model& model) {
  return {count_element(), count_node(), static_cast<double>(model.node_count()) / model.element_count()};
}

}  // namespace fexp::bench
