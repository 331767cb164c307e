// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "physics/j2_laws.hpp"
#include "physics/layered_shell.hpp"

/// Plastic laws and layered elements driven through strains without a mesh.
namespace fexp::test {

template <class Law>
[[nodiscard]] physics::LayeredSection layered_section(const Law& law, int points,
                                                      physics::Quadrature rule = physics::Quadrature::gauss) {
  return {physics::through_thickness(rule, points), law.moduli(), physics::J2Elasticity::of(law.moduli()),
          law.plasticity()};
}

/// Stresses sxx, syy and sxy.
[[nodiscard]] inline std::array<double, 3> components(const physics::LayerPoint<double>& p) {
  return {0.5 * (p.stress.sum + p.stress.difference), 0.5 * (p.stress.sum - p.stress.difference), p.stress.shear};
}

[[nodiscard]] inline double von_mises(const physics::LayerPoint<double>& p) {
  const auto [xx, yy, xy] = components(p);
  return std::sqrt(xx * xx - xx * yy + yy * yy + 3.0 * xy * xy);
}

/// One point of a plastic law in a frame that does not turn.
template <class Law>
class PointDriver {
  physics::LayeredSection section_;

 public:
  explicit PointDriver(const Law& law) : section_(layered_section(law, 1)) {}

  physics::LayerPoint<double> point{};
  physics::PointConditions<double> conditions{section_.plasticity.heat.initial, 0.0};

  /// By increments exx, eyy and gxy.
  physics::PointChange<double> stretch(const std::array<double, 3>& strain, double dt = 1.0) {
    return std::visit(
        [&](const auto& curve) {
          const physics::LayerStep<double> step(section_, dt, 0.0);
          const physics::PlaneTensor<double> e{strain[0] + strain[1], strain[0] - strain[1], strain[2]};
          if (!section_.has_conditions()) {
            return physics::update_point<double>(step, curve, e, point);
          }
          const physics::PointChange<double> change =
              physics::ConditionStep(section_.plasticity, dt).update<double>(step, curve, e, point, conditions);
          conditions.temperature += section_.plasticity.heat.heating * change.plastic_work;
          return change;
        },
        section_.plasticity.hardening);
  }
  [[nodiscard]] double yield_stress() const {
    double slope = 0.0;
    return std::visit([&](const auto& curve) { return curve.at(point.strain, slope); }, section_.plasticity.hardening);
  }
  [[nodiscard]] const physics::LayeredSection& section() const { return section_; }
};

/// One layered element of unit area.
template <class Law>
class LayeredDriver {
 public:
  LayeredDriver(const Law& law, double thickness, int points, physics::Quadrature rule = physics::Quadrature::gauss)
      : section_(layered_section(law, points, rule)),
        stiffness_(physics::ShellSection{thickness, law.moduli(), 0.1}),
        rows_(static_cast<std::size_t>(section_.rows())) {
    rows_[physics::layer_thickness] = thickness;
    for (int p = 0; p < (section_.plasticity.heat.heats() ? points : 0); ++p) {
      rows_[static_cast<std::size_t>(section_.temperature_row(p))] = section_.plasticity.heat.initial;
    }
  }

  physics::ShellResultants<double> resultants{};

  void step(const physics::ShellIncrement<double>& increment, double dt = 1.0) {
    std::visit(
        [&](const auto& curve) {
          const auto load = [&](int r) { return rows_[static_cast<std::size_t>(r)]; };
          const auto store = [&](int r, double value) { rows_[static_cast<std::size_t>(r)] = value; };
          if (section_.has_conditions()) {
            physics::update_layered<true>(stiffness_, section_, curve, dt, 1.0, increment, load, store, resultants);
          } else {
            physics::update_layered(stiffness_, section_, curve, dt, 1.0, increment, load, store, resultants);
          }
        },
        section_.plasticity.hardening);
  }
  [[nodiscard]] double row(int r) const { return rows_[static_cast<std::size_t>(r)]; }
  [[nodiscard]] const physics::LayeredSection& section() const { return section_; }
  [[nodiscard]] const physics::ShellStiffness& stiffness() const { return stiffness_; }

 private:
  physics::LayeredSection section_;
  physics::ShellStiffness stiffness_;
  std::vector<double> rows_;
};

}  // namespace fexp::test
