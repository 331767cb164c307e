// SPDX-License-Identifier: Apache-2.0
#include "bench/element_step.hpp"

#include <array>
#include <variant>
#include <vector>

#include "model/state.hpp"
#include "physics/layered_shell.hpp"
#include "solve/kernels.hpp"

namespace fexp::bench {

namespace {

constexpr double motion_bytes = sizeof(model::NodeMotion);
constexpr double inverse_bytes = sizeof(solve::InverseInertia);
constexpr double corners_bytes = sizeof(std::array<Index, 3>);

/// A layered element that is stretched so that all its points flow, by increments of strain as in a crash.
OperationCount count_layered(const model::SectionData& section, const physics::ShellStiffness& stiffness) {
  const physics::LayeredSection& layered = section.layered;
  std::vector<Counted> rows(at(section.layer_rows()));
  rows[physics::layer_thickness] = section.thickness;
  const auto load = [&](int row) { return rows[at(row)]; };
  const auto store = [&](int row, const Counted& value) { rows[at(row)] = value; };
  TriangleMotion<Counted> motion{};
  motion.position = {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  const double dt = 1.0e-6;
  const auto step = [&] {
    static_cast<void>(step_element<Counted>(
        stiffness, motion, dt, [&](const Counted& area, const physics::ShellIncrement<Counted>& increment) {
          std::visit(
              [&](const auto& curve) {
                if (layered.has_conditions()) {
                  physics::update_layered<true>(stiffness, layered, curve, dt, area, increment, load, store,
                                                motion.resultants);
                } else {
                  physics::update_layered(stiffness, layered, curve, dt, area, increment, load, store,
                                          motion.resultants);
                }
              },
              layered.plasticity.hardening);
        }));
  };
  motion.velocity[1].x = 5.0e-5 / dt;
  for (int i = 0; i < 400; ++i) {
    step();
  }
  return count_operations(step);
}

OperationCount count_element(const model::SectionData& section, double drilling) {
  const physics::ShellStiffness stiffness(physics::ShellSection{section.thickness, section.moduli, drilling});
  OperationCount count;
  if (section.layered.points.count > 0) {
    count = count_layered(section, stiffness);
  } else {
    // Any motion will do: there are no branches.
    count = count_operations([&] {
      TriangleMotion<Counted> motion{};
      motion.position = {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
      static_cast<void>(step_element<Counted>(stiffness, motion, 1.0e-3));
    });
  }
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
  const model::SectionData& section = model.sections.front();
  return {count_element(section, model.run.drilling), count_node(),
          static_cast<double>(model.node_count()) / model.element_count(),
          (model::element_rows + section.layer_rows()) * double{sizeof(double)}};
}

}  // namespace fexp::bench
